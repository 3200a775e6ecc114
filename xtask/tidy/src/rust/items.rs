//! What an item is called, and whether it exists in tests only.

use proc_macro2::{TokenStream, TokenTree};
use syn::punctuated::Punctuated;
use syn::{Attribute, ForeignItem, ImplItem, Item, Meta, Token};

/// Whether an item is left out of everything but tests.
pub fn is_test_only(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg")
                && attribute
                    .parse_args::<Meta>()
                    .is_ok_and(|meta| needs_test(&meta))
    })
}

/// Whether a condition of `cfg` cannot hold without `test`.
fn needs_test(condition: &Meta) -> bool {
    let parts = |list: &syn::MetaList| {
        list.parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated)
            .unwrap_or_default()
    };
    match condition {
        Meta::Path(path) => path.is_ident("test"),
        Meta::List(list) if list.path.is_ident("all") => parts(list).iter().any(needs_test),
        Meta::List(list) if list.path.is_ident("any") => {
            let parts = parts(list);
            !parts.is_empty() && parts.iter().all(needs_test)
        }
        _ => false,
    }
}

/// The attributes of an item.
pub fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::ExternCrate(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::ForeignMod(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::TraitAlias(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// The attributes of an item of an `impl`.
pub fn impl_attributes(item: &ImplItem) -> &[Attribute] {
    match item {
        ImplItem::Const(item) => &item.attrs,
        ImplItem::Fn(item) => &item.attrs,
        ImplItem::Type(item) => &item.attrs,
        ImplItem::Macro(item) => &item.attrs,
        _ => &[],
    }
}

/// The names that an item defines in its module; those of `use` and `mod` aside.
pub fn names(item: &Item) -> Vec<String> {
    let ident = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::TraitAlias(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        Item::Macro(item) => match &item.ident {
            Some(macro_rules) => macro_rules,
            None => return names_in_macro(item.mac.tokens.clone()),
        },
        Item::ForeignMod(item) => return item.items.iter().filter_map(foreign_name).collect(),
        _ => return Vec::new(),
    };
    vec![ident.to_string()]
}

fn foreign_name(item: &ForeignItem) -> Option<String> {
    match item {
        ForeignItem::Fn(item) => Some(item.sig.ident.to_string()),
        ForeignItem::Static(item) => Some(item.ident.to_string()),
        ForeignItem::Type(item) => Some(item.ident.to_string()),
        _ => None,
    }
}

/// The items that stand written out in the call of a macro, such as `self_cell!(struct Owner { .. })`.
fn names_in_macro(tokens: TokenStream) -> Vec<String> {
    const KEYWORDS: [&str; 6] = ["struct", "enum", "fn", "static", "const", "type"];
    let words: Vec<Option<String>> = tokens
        .into_iter()
        .map(|token| match token {
            TokenTree::Ident(ident) => Some(ident.to_string()),
            _ => None,
        })
        .collect();
    let defined = words.windows(2).filter_map(|pair| match pair {
        [Some(keyword), Some(name)] if KEYWORDS.contains(&keyword.as_str()) => Some(name.clone()),
        _ => None,
    });
    defined.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_that_need_a_test_are_seen() {
        for (condition, expected) in [
            ("cfg(test)", true),
            ("cfg(all(test, unix))", true),
            ("cfg(any(test, feature = \"fakes\"))", false),
            ("cfg(not(test))", false),
            ("cfg_attr(test, allow(dead_code))", false),
            ("test", true),
        ] {
            let item: syn::ItemFn = syn::parse_str(&format!("#[{condition}] fn f() {{}}")).unwrap();
            assert_eq!(is_test_only(&item.attrs), expected, "{condition}");
        }
    }

    #[test]
    fn items_of_macro_calls_have_names() {
        let item: Item =
            syn::parse_str("self_cell!(pub struct Owner { owner: Vec<u8> });").unwrap();
        assert_eq!(names(&item), ["Owner"]);
    }
}

//! Where a file can be changed, and how.
//!
//! Left alone is what is only compiled for tests or for other targets, and what is worked out by the compiler: there no run can ask which change counts.

use std::ops::Range;

use anyhow::{Result, anyhow};
use proc_macro2::Span;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{
    Attribute, BinOp, Block, Expr, ExprBinary, ExprMatch, ExprRepeat, ExprUnary, GenericArgument,
    ImplItem, ImplItemFn, Item, ItemFn, ItemMod, Pat, PatGuard, ReturnType, Signature, TraitItem,
    TraitItemFn, Type, UnOp,
};

use crate::change::{Change, Edit};

/// All changes of a file, and the modules that files beside it hold.
///
/// # Errors
/// With the line where it is no Rust.
pub(crate) fn of_file(name: &str, text: &str) -> Result<(Vec<Change>, Vec<String>)> {
    let syntax = syn::parse_file(text)
        .map_err(|error| anyhow!("{name}:{}: {error}", error.span().start().line))?;
    let mut places = Places {
        name,
        text,
        function: String::new(),
        changes: Vec::new(),
        modules: Vec::new(),
    };
    places.visit_file(&syntax);
    Ok((places.changes, places.modules))
}

struct Places<'a> {
    name: &'a str,
    text: &'a str,
    function: String,
    changes: Vec<Change>,
    modules: Vec<String>,
}

impl Places<'_> {
    fn add(&mut self, span: Span, what: String, edit: Edit) {
        self.changes.push(Change {
            file: self.name.to_owned(),
            line: span.start().line,
            function: self.function.clone(),
            what,
            edit,
        });
    }

    fn text_of(&self, span: Span) -> &str {
        &self.text[span.byte_range()]
    }

    /// A function that a run can change: its value, and what is in it.
    fn function(&mut self, attributes: &[Attribute], signature: &Signature, body: &Block) {
        if signature.constness.is_some() || is_left_alone(attributes) {
            return;
        }
        let around = std::mem::replace(&mut self.function, signature.ident.to_string());
        let at = body.brace_token.span.open().byte_range().end;
        for value in values(&signature.output) {
            let what = match value.as_str() {
                "" => "return at once".to_owned(),
                value => format!("return {value}"),
            };
            self.add(signature.ident.span(), what, Edit::Return { at, value });
        }
        self.visit_block(body);
        self.function = around;
    }

    /// An arm with a guard, of a match with or without an arm for all that is left.
    fn guarded(&mut self, guarded: &PatGuard, has_last: bool) {
        let guard = &*guarded.guard;
        if matches!(guard, Expr::Let(_)) || is_chain(guard) {
            return;
        }
        let span = guard.span();
        if has_last {
            self.never(
                &guarded.pat,
                span.byte_range().start,
                Some(span.byte_range().end),
            );
        }
        for value in ["true", "false"] {
            let what = format!("{value} for a guard");
            self.instead(span, span.byte_range(), what, value.to_owned());
        }
    }

    /// An arm that is left out.
    fn never(&mut self, pattern: &Pat, at: usize, guard_end: Option<usize>) {
        let what = format!("no arm {}", self.text_of(pattern.span()));
        self.add(pattern.span(), what, Edit::Never { at, guard_end });
    }

    fn instead(&mut self, at: Span, of: Range<usize>, what: String, other: String) {
        self.add(at, what, Edit::Instead { of, other });
    }
}

impl<'ast> Visit<'ast> for Places<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        match item {
            Item::Fn(ItemFn {
                attrs, sig, block, ..
            }) => self.function(attrs, sig, block),
            Item::Mod(ItemMod { attrs, .. }) if is_left_alone(attrs) => {}
            Item::Mod(ItemMod {
                ident,
                content: None,
                ..
            }) => self.modules.push(ident.to_string()),
            Item::Impl(one) if is_left_alone(&one.attrs) => {}
            Item::Mod(_) | Item::Impl(_) | Item::Trait(_) => visit::visit_item(self, item),
            // Constants, types and macros.
            _ => {}
        }
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        if let ImplItem::Fn(ImplItemFn {
            attrs, sig, block, ..
        }) = item
        {
            self.function(attrs, sig, block);
        }
    }

    fn visit_trait_item(&mut self, item: &'ast TraitItem) {
        if let TraitItem::Fn(TraitItemFn {
            attrs,
            sig,
            default: Some(block),
            ..
        }) = item
        {
            self.function(attrs, sig, block);
        }
    }

    fn visit_expr_binary(&mut self, expr: &'ast ExprBinary) {
        for other in others(&expr.op).iter().filter(|_| !has_let(expr)) {
            let what = format!("{} for {}", other, self.text_of(expr.op.span()));
            let (left, right) = (
                self.text_of(expr.left.span()),
                self.text_of(expr.right.span()),
            );
            // What is assigned to is no value in parentheses.
            let instead = match other.strip_suffix('=').filter(|rest| is_sign(rest)) {
                Some(_) => format!("{left} {other} ({right})"),
                None => format!("({left}) {other} ({right})"),
            };
            let at = expr.op.span();
            self.instead(at, expr.span().byte_range(), what, instead);
        }
        visit::visit_expr_binary(self, expr);
    }

    fn visit_expr_unary(&mut self, expr: &'ast ExprUnary) {
        let sign = match expr.op {
            UnOp::Neg(_) => Some("-"),
            UnOp::Not(_) => Some("!"),
            _ => None,
        };
        if let Some(sign) = sign {
            let other = format!("({})", self.text_of(expr.expr.span()));
            let of = expr.span().byte_range();
            self.instead(expr.op.span(), of, format!("no {sign}"), other);
        }
        visit::visit_expr_unary(self, expr);
    }

    fn visit_expr_match(&mut self, expr: &'ast ExprMatch) {
        let has_last = expr.arms.iter().any(|arm| matches!(arm.pat, Pat::Wild(_)));
        for arm in &expr.arms {
            match &arm.pat {
                Pat::Wild(_) => {}
                Pat::Guard(guarded) => self.guarded(guarded, has_last),
                pattern if has_last => {
                    let at = pattern.span().byte_range().end;
                    self.never(pattern, at, None);
                }
                _ => {}
            }
        }
        visit::visit_expr_match(self, expr);
    }

    fn visit_pat(&mut self, pattern: &'ast Pat) {
        if let Pat::Guard(guarded) = pattern {
            self.visit_expr(&guarded.guard);
        }
    }

    // What the compiler works out.

    fn visit_expr_repeat(&mut self, expr: &'ast ExprRepeat) {
        self.visit_expr(&expr.expr);
    }

    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}

    fn visit_generic_argument(&mut self, _: &'ast GenericArgument) {}

    fn visit_type(&mut self, _: &'ast Type) {}
}

/// Whether `let` stands somewhere in a chain of `&&`.
fn has_let(expr: &ExprBinary) -> bool {
    matches!(expr.op, BinOp::And(_))
        && [&expr.left, &expr.right]
            .into_iter()
            .any(|side| matches!(**side, Expr::Let(_)) || is_chain(side))
}

fn is_chain(expr: &Expr) -> bool {
    matches!(expr, Expr::Binary(binary) if has_let(binary))
}

fn is_sign(text: &str) -> bool {
    matches!(
        text,
        "+" | "-" | "*" | "/" | "%" | "<<" | ">>" | "&" | "|" | "^"
    )
}

/// Operators that one is exchanged for.
fn others(operator: &BinOp) -> &'static [&'static str] {
    match operator {
        BinOp::Add(_) => &["-", "*"],
        BinOp::Sub(_) => &["+", "/"],
        BinOp::Mul(_) => &["+", "/"],
        BinOp::Div(_) => &["%", "*"],
        BinOp::Rem(_) => &["/", "+"],
        BinOp::And(_) => &["||"],
        BinOp::Or(_) => &["&&"],
        BinOp::BitXor(_) => &["|", "&"],
        BinOp::BitAnd(_) => &["|", "^"],
        BinOp::BitOr(_) => &["&", "^"],
        BinOp::Shl(_) => &[">>"],
        BinOp::Shr(_) => &["<<"],
        BinOp::Eq(_) => &["!="],
        BinOp::Ne(_) => &["=="],
        BinOp::Lt(_) => &["==", ">", "<="],
        BinOp::Gt(_) => &["==", "<", ">="],
        BinOp::Le(_) => &[">"],
        BinOp::Ge(_) => &["<"],
        BinOp::AddAssign(_) => &["-=", "*="],
        BinOp::SubAssign(_) => &["+=", "/="],
        BinOp::MulAssign(_) => &["+=", "/="],
        BinOp::DivAssign(_) => &["%=", "*="],
        BinOp::RemAssign(_) => &["/=", "+="],
        BinOp::BitXorAssign(_) => &["|=", "&="],
        BinOp::BitAndAssign(_) => &["|=", "^="],
        BinOp::BitOrAssign(_) => &["&=", "^="],
        BinOp::ShlAssign(_) => &[">>="],
        BinOp::ShrAssign(_) => &["<<="],
        _ => &[],
    }
}

/// What a function of this type may return at once; of types that are not known here what they are by default, where they have that.
fn values(output: &ReturnType) -> Vec<String> {
    match output {
        ReturnType::Default => vec![String::new()],
        ReturnType::Type(_, of) => values_of(of),
    }
}

fn values_of(of: &Type) -> Vec<String> {
    let all = |values: &[&str]| values.iter().map(|value| (*value).to_owned()).collect();
    match of {
        Type::Array(array) => values_of(&array.elem)
            .into_iter()
            .map(|value| format!("core::array::from_fn(|_| {value})"))
            .collect(),
        Type::Tuple(tuple) if tuple.elems.is_empty() => all(&["()"]),
        Type::Path(path) => {
            let Some(last) = path.path.segments.last() else {
                return Vec::new();
            };
            match last.ident.to_string().as_str() {
                "bool" => all(&["true", "false"]),
                "f32" | "f64" => all(&["0.0", "1.0", "-1.0"]),
                "u8" | "u16" | "u32" | "u64" | "u128" | "usize" => all(&["0", "1"]),
                "i8" | "i16" | "i32" | "i64" | "i128" | "isize" => all(&["0", "1", "-1"]),
                "Option" => {
                    let inner = inner(last).map(values_of).unwrap_or_default();
                    let some = inner.into_iter().map(|value| format!("Some({value})"));
                    ["None".to_owned()].into_iter().chain(some).collect()
                }
                "Result" => {
                    let inner = inner(last).map(values_of).unwrap_or_default();
                    inner
                        .into_iter()
                        .map(|value| format!("Ok({value})"))
                        .collect()
                }
                _ => all(&["Default::default()"]),
            }
        }
        Type::Reference(to) if to.mutability.is_none() => match &*to.elem {
            Type::Slice(_) => all(&["&[]"]),
            Type::Path(path) if path.path.is_ident("str") => all(&["\"\""]),
            _ => Vec::new(),
        },
        Type::Tuple(_) => all(&["Default::default()"]),
        _ => Vec::new(),
    }
}

/// The first type in angle brackets.
fn inner(segment: &syn::PathSegment) -> Option<&Type> {
    let syn::PathArguments::AngleBracketed(arguments) = &segment.arguments else {
        return None;
    };
    arguments.args.iter().find_map(|one| match one {
        GenericArgument::Type(of) => Some(of),
        _ => None,
    })
}

/// Whether attributes say that something is for tests or for some targets alone.
fn is_left_alone(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|one| {
        let syn::Meta::List(list) = &one.meta else {
            return one.path().is_ident("test");
        };
        let told = list.tokens.to_string();
        one.path().is_ident("cfg")
            && ["test", "target", "not"]
                .iter()
                .any(|word| told.contains(word))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(source: &str) -> Vec<String> {
        let (changes, _) = of_file("a.rs", source).unwrap_or_default();
        changes.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn each_change_says_where_it_is_and_what_is_done() {
        let source = "fn is_less(a: u8, b: u8) -> bool {\n    a < b\n}\n";
        let expected = [
            "a.rs:1: return true in is_less",
            "a.rs:1: return false in is_less",
            "a.rs:2: == for < in is_less",
            "a.rs:2: > for < in is_less",
            "a.rs:2: <= for < in is_less",
        ];
        assert_eq!(told(source), expected);
    }

    #[test]
    fn what_the_compiler_works_out_and_what_is_for_tests_is_left_alone() {
        let source = "const A: usize = 1 + 2;\nconst fn b(c: usize) -> usize { c + 1 }\nfn d() { let e = [0u8; A + 1]; const F: u8 = 1 + 1; g::<{ 1 + 1 }>(); }\n\
                      #[cfg(test)]\nmod tests { fn h() -> bool { 1 < 2 } }\n#[cfg(test)]\nmod more;\n#[test]\nfn i() -> bool { true }\n";
        assert_eq!(told(source), ["a.rs:3: return at once in d"]);
    }

    #[test]
    fn arms_are_left_out_where_another_takes_what_is_left() {
        let source = "fn f(a: u8) {\n    match a {\n        0 => {}\n        1 if g() => {}\n        _ => {}\n    }\n    match a {\n        0..=255 => {}\n    }\n}\n";
        let expected = [
            "a.rs:1: return at once in f",
            "a.rs:3: no arm 0 in f",
            "a.rs:4: no arm 1 in f",
            "a.rs:4: true for a guard in f",
            "a.rs:4: false for a guard in f",
        ];
        assert_eq!(told(source), expected);
    }

    #[test]
    fn conditions_that_bind_names_are_kept() {
        assert_eq!(
            told("fn f(a: Option<u8>) { if let Some(b) = a && b > 0 { } }"),
            [
                "a.rs:1: return at once in f",
                "a.rs:1: == for > in f",
                "a.rs:1: < for > in f",
                "a.rs:1: >= for > in f"
            ]
        );
    }

    #[test]
    fn modules_in_files_of_their_own_are_named() {
        let (_, modules) = of_file(
            "a.rs",
            "mod b;\nmod c { fn d() {} }\n#[cfg(test)]\nmod tests;\npub mod e;\n",
        )
        .unwrap_or_default();
        assert_eq!(modules, ["b", "e"]);
    }
}

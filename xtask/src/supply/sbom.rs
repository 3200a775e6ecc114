//! The list of parts for programs: CycloneDX 1.5. Without time and number, so that two builds have the same.

use anyhow::Result;
use serde_json::{Value, json};

use super::parts::Part;

/// The text of the list.
///
/// Errors never, but as JSON may.
pub(crate) fn text(product: &str, parts: &[Part]) -> Result<String> {
    let components: Vec<Value> = parts.iter().map(component).collect();
    let own = json!({"type": "application", "name": product, "version": env!("CARGO_PKG_VERSION")});
    let list = json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": own},
        "components": components,
    });
    Ok(serde_json::to_string_pretty(&list)? + "\n")
}

fn component(part: &Part) -> Value {
    let address = address(part);
    let mut component = json!({
        "type": "library",
        "bom-ref": address,
        "name": part.name,
        "version": part.version,
        "licenses": [{"expression": part.licence}],
        "purl": address,
    });
    if let Some((algorithm, hex)) = &part.digest {
        component["hashes"] = json!([{"alg": algorithm, "content": hex}]);
    }
    component
}

/// The package's address (purl): an npm scope's sign is escaped.
fn address(part: &Part) -> String {
    let name = part.name.replace('@', "%40");
    let version = part.version.replace('+', "%2B");
    format!("pkg:{}/{name}@{version}", part.kind)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_component_has_address_licence_and_digest() {
        let part = Part {
            kind: "npm",
            name: "@a/b".to_owned(),
            version: "1.0.0+2".to_owned(),
            licence: "MIT OR ISC".to_owned(),
            digest: Some(("SHA-512", "ab".to_owned())),
            folder: None,
            from_registry: true,
        };
        let list: Value = serde_json::from_str(&text("x", &[part]).unwrap()).unwrap();
        let one = &list["components"][0];
        assert_eq!(one["purl"], "pkg:npm/%40a/b@1.0.0%2B2");
        assert_eq!(one["licenses"][0]["expression"], "MIT OR ISC");
        assert_eq!(one["hashes"][0]["content"], "ab");
        assert_eq!(list["specVersion"], "1.5");
    }
}

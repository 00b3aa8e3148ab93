//! Certificates are what docs/reference/certificate.schema.json says, and it says nothing that none
//! has.

use super::reading::{asked, obj};
use super::rest::{cloth_on_table, on_table};
use super::*;
use crate::files::{AskedFiles, certify};
use crate::{Certificate, InputFile};
use serde_json::Value;
use std::collections::BTreeSet;

const SCHEMA: &str = include_str!("../../../docs/reference/certificate.schema.json");

/// What is wrong with a value by the schema; empty where it is a certificate.
fn faults(value: &Value) -> String {
    let (mut schemas, mut compiler) = (boon::Schemas::new(), boon::Compiler::new());
    let name = "https://toile.invalid/certificate.json";
    compiler.add_resource(name, serde_json::from_str(SCHEMA).unwrap()).unwrap();
    let index = compiler.compile(name, &mut schemas).unwrap();
    schemas.validate(value, index).err().map(|e| e.to_string()).unwrap_or_default()
}

fn of_judgement(found: Judgement) -> Value {
    let inputs = vec![InputFile::of("garment", "skirt.obj", b"skirt")];
    serde_json::to_value(Certificate::new(inputs, found, None, Vec::new())).unwrap()
}

/// Certificates of every kind: all judged, nothing judged, damaged, compared, let go.
fn certificates() -> Vec<Value> {
    let dir = tempfile::tempdir().unwrap();
    let garment = dir.path().join("skirt.obj");
    std::fs::write(&garment, obj(&Skirt::new(12, 8), 1.0)).unwrap();
    let compared = AskedFiles { compare: Some(garment.clone()), ..asked(&garment) };
    let files = [compared, cloth_on_table(dir.path(), &on_table())];
    let of_files = files.map(|a| serde_json::to_value(certify(&a).unwrap().0).unwrap());
    let mut bare = Skirt::new(12, 8);
    bare.meshes.texture.iter_mut().for_each(|t| *t = None);
    let none = Err("no body is known: name one with `--body`".to_owned());
    let nothing = judge(&bare.subject(None, none), &CheckLimits::default());
    let mut torn = Skirt::new(12, 8);
    torn.meshes.positions[20] = Point3::new(f64::NAN, 0.0, 0.0);
    torn.meshes.triangles.swap_remove(7);
    let mut pleated = Skirt::new(12, 8).judged();
    pleated.gaps.unmeasured.push(("pleat".into(), "the layers of a pleat are folded".into()));
    pleated.girths.insert("waist".into(), toile_core::artifact::GirthFigures { cloth_m: 0.8, body_m: 0.7 });
    let judged = [Skirt::new(12, 8).judged(), nothing, torn.judged(), pleated].map(of_judgement);
    of_files.into_iter().chain(judged).collect()
}

#[test]
fn each_certificate_is_what_the_schema_says() {
    for certificate in certificates() {
        assert_eq!(faults(&certificate), "", "{certificate:#}");
    }
}

#[test]
fn what_is_no_certificate_is_told() {
    let sound = of_judgement(Skirt::new(12, 8).judged());
    let changed = |at: &str, to: Value| {
        let mut value = sound.clone();
        *value.pointer_mut(at).unwrap() = to;
        faults(&value)
    };
    for (at, to) in [
        ("/verdict", "maybe".into()),
        ("/certificate", 3.into()),
        ("/checks/0/name", "beauty".into()),
        ("/checks/0/verdict", "not judged".into()),
        ("/inputs/0/digest", "1234".into()),
        ("/seams/0/at", Value::from(vec![0.0, 1.0])),
        ("/panels/front/p99", "small".into()),
    ] {
        assert_ne!(changed(at, to), "", "{at}");
    }
}

/// The names of all properties of a schema.
fn properties(schema: &Value, out: &mut BTreeSet<String>) {
    if let Some(own) = schema.get("properties").and_then(Value::as_object) {
        out.extend(own.keys().cloned());
    }
    let parts: Vec<&Value> = match schema {
        Value::Object(all) => all.values().collect(),
        Value::Array(all) => all.iter().collect(),
        _ => Vec::new(),
    };
    parts.into_iter().for_each(|part| properties(part, out));
}

fn keys(value: &Value, out: &mut BTreeSet<String>) {
    match value {
        Value::Object(all) => all.iter().for_each(|(key, value)| {
            out.insert(key.clone());
            keys(value, out);
        }),
        Value::Array(all) => all.iter().for_each(|value| keys(value, out)),
        _ => {}
    }
}

#[test]
fn every_property_of_the_schema_is_in_a_certificate() {
    let (mut said, mut written) = (BTreeSet::new(), BTreeSet::new());
    properties(&serde_json::from_str(SCHEMA).unwrap(), &mut said);
    certificates().iter().for_each(|c| keys(c, &mut written));
    let unwritten: Vec<&String> = said.difference(&written).collect();
    assert!(unwritten.is_empty(), "{unwritten:?}");
}

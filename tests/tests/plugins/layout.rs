//! The header and the Rust types describe the same memory.

use std::fmt::Write;
use std::mem::offset_of;
use std::process::Command;
use toile_core::artifact::{BodyContact, SelfContact};
use toile_core::plugin::abi;

macro_rules! fields {
    ($($c:literal = $t:ty { $($cf:literal = $f:ident),* $(,)? })*) => {
        [$(($c, size_of::<$t>(), vec![$(($cf, offset_of!($t, $f))),*])),*]
    };
}

#[test]
fn the_header_has_the_layout_of_the_rust_types() {
    let types = fields! {
        "toile_text" = abi::Text { "ptr" = ptr, "len" = len }
        "toile_field" = abi::Field { "name" = name, "data" = data, "count" = count, "kind" = kind, "width" = width,
            "owner" = owner }
        "toile_owner" = abi::Owner { "ctx" = ctx, "retain" = retain, "release" = release }
        "toile_record" = abi::Record { "fields" = fields, "count" = count }
        "toile_port" = abi::Port { "name" = name, "kind" = kind, "arity" = arity, "flags" = flags }
        "toile_param" = abi::Param { "name" = name, "doc" = doc, "kind" = kind, "unit" = unit,
            "default_value" = default, "min" = min, "max" = max, "flags" = flags, "reserved" = reserved }
        "toile_sink" = abi::Sink { "ctx" = ctx, "grow" = grow }
        "toile_cloth" = abi::Cloth { "positions" = positions, "points" = points, "triangles" = triangles,
            "triangle_count" = triangle_count }
        "toile_collider_card" = abi::ColliderCard { "thickness" = thickness, "friction" = friction,
            "restitution" = restitution, "penalty" = penalty, "self_collision" = self_collision,
            "penalty_law" = penalty_law }
        "toile_collider_table" = abi::ColliderTable { "size" = size, "card" = card,
            "body_contacts" = body_contacts, "body_hits" = body_hits, "self_contacts" = self_contacts,
            "conservative_bounds" = conservative_bounds, "self_crossings" = self_crossings, "share" = share,
            "why" = why, "destroy" = destroy }
        "toile_collider" = abi::Collider { "table" = table, "self" = this, "signature" = signature }
        "toile_input" = abi::Input { "port" = port, "kind" = kind, "name" = name, "record" = record,
            "collider" = collider }
        "toile_call" = abi::Call { "size" = size, "ports" = ports, "fed" = fed, "inputs" = inputs,
            "count" = count, "stage" = stage, "entry" = entry, "base" = base }
        "toile_host" = abi::Host { "size" = size, "major" = major, "minor" = minor, "threads" = threads,
            "ctx" = ctx, "alloc" = alloc, "give" = give, "give_collider" = give_collider, "answer" = answer,
            "fail" = fail, "warn" = warn, "progress" = progress, "figure" = figure, "cancelled" = cancelled,
            "parallel_for" = parallel_for, "reads" = reads, "note" = note }
        "toile_stage_table" = abi::StageTable { "version" = version, "name" = name, "role" = role,
            "doc" = doc, "source" = source, "example" = example, "contracts" = contracts,
            "contract_count" = contract_count, "params" = params, "param_count" = param_count,
            "inputs" = inputs, "input_count" = input_count, "outputs" = outputs, "output_count" = output_count,
            "create" = create, "describe" = describe, "run" = run, "destroy" = destroy, "check" = check }
        "toile_declaration" = abi::Declaration { "magic" = magic, "major" = major, "minor" = minor,
            "size" = size, "stage_size" = stage_size, "param_size" = param_size, "port_size" = port_size,
            "name" = name, "version" = version, "stages" = stages }
        "toile_body_contact" = BodyContact { "vertex" = vertex, "point" = point, "normal" = normal,
            "distance" = distance }
        "toile_self_contact" = SelfContact { "vertices" = vertices, "weights" = weights, "normal" = normal,
            "distance" = distance }
    };
    let mut source =
        String::from("#include \"toile_plugin.h\"\n#define SAME(a, b) _Static_assert((a) == (b), #a)\n");
    for (name, size, fields) in &types {
        writeln!(source, "SAME(sizeof({name}), {size});").unwrap();
        for (field, offset) in fields {
            writeln!(source, "SAME(offsetof({name}, {field}), {offset});").unwrap();
        }
    }
    for (name, value) in [("MAJOR", abi::MAJOR), ("MINOR", abi::MINOR)] {
        writeln!(source, "SAME(TOILE_ABI_{name}, {value});").unwrap();
    }
    compile(&source, &[]);
    let old = format!(
        "SAME(sizeof(toile_stage_table), {});\nSAME(sizeof(toile_host), {});\n",
        abi::STAGE_SIZE_1_0,
        abi::HOST_SIZE_1_0
    );
    compile(
        &format!("#include \"toile_plugin.h\"\n#define SAME(a, b) _Static_assert((a) == (b), #a)\n{old}"),
        &["-DTOILE_ABI_MINOR=0"],
    );
}

fn compile(source: &str, flags: &[&str]) {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("layout.c");
    std::fs::write(&file, source).unwrap();
    let made = Command::new(std::env::var("CC").unwrap_or_else(|_| "cc".into()))
        .args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"])
        .args(flags)
        .arg("-I")
        .arg(toile_tests::root().join("core/include"))
        .arg(&file)
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
}

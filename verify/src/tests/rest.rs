//! A garment that is let go: cloth that lies on a table stays, cloth that is out of place moves.

use super::reading::{asked, obj};
use super::*;
use crate::files::{AskedFiles, ClothStages, Up, certify};
use std::path::Path;
use std::sync::Arc;
use toile_drape::collide::BvhCollider;
use toile_drape::fabric::Preset;

/// The height of the table, metres, and the distance at which it holds cloth off.
const TABLE: f64 = 0.7;
const OFF: f64 = 1.5e-3;
/// Cells of each panel, of 16 mm.
const COLUMNS: usize = 40;
const ROWS: usize = 32;

/// Two panels side by side on a table, sewn along one side.
pub(super) fn on_table() -> Skirt {
    let mut skirt = Skirt::new(COLUMNS, ROWS);
    for panel in 0..2 {
        for row in 0..=ROWS {
            for column in 0..=COLUMNS {
                let v = skirt.at(panel, column, row);
                let x = width(COLUMNS) * (panel as f64 - 1.0 + column as f64 / COLUMNS as f64);
                let z = HEIGHT * (0.5 - row as f64 / ROWS as f64);
                skirt.meshes.positions[v] = Point3::new(x, TABLE + OFF, z);
            }
        }
    }
    skirt
}

/// A box of two metres by two.
fn table() -> String {
    let corner = |k: usize| [k & 1, k >> 1 & 1, k >> 2 & 1].map(|b| b as f64);
    let corners = (0..8).map(corner);
    let mut text: String =
        corners.map(|[x, y, z]| format!("v {} {} {}\n", 2.0 * x - 1.0, TABLE * y, 2.0 * z - 1.0)).collect();
    for [a, b, c, d] in [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]] {
        text += &format!("f {a} {b} {c} {d}\n");
    }
    text
}

/// The files of cloth on the table, with its fabric.
pub(super) fn cloth_on_table(folder: &Path, skirt: &Skirt) -> AskedFiles {
    let (garment, body) = (folder.join("cloth.obj"), folder.join("table.obj"));
    std::fs::write(&garment, obj(skirt, 1.0)).unwrap();
    std::fs::write(&body, table()).unwrap();
    let (fabric, collider) = (Arc::new(Preset::default()), Arc::new(BvhCollider::default()));
    let cloth = Some(ClothStages { fabric, collider });
    AskedFiles { body: Some(body), up: Some(Up::Y), cloth, ..asked(&garment) }
}

/// What fails of the cloth when it is let go, how far it moves, and where the farthest.
fn let_go(skirt: &Skirt) -> (Vec<&'static str>, f64, String) {
    let dir = tempfile::tempdir().unwrap();
    let (certificate, _) = certify(&cloth_on_table(dir.path(), skirt)).unwrap();
    let fails = certificate.checks.iter().filter(|c| c.verdict == Verdict::Fails).map(|c| c.name);
    let shift = certificate.checks.iter().find(|c| c.name == "rest_shift").unwrap();
    (fails.collect(), shift.value.unwrap(), shift.words.clone())
}

#[test]
fn cloth_that_lies_on_a_table_stays() {
    let (fails, moved, _) = let_go(&on_table());
    assert_eq!(fails, Vec::<&str>::new());
    assert!(moved < 1e-4, "{moved}");
}

#[test]
fn a_panel_that_is_lifted_off_falls() {
    let mut skirt = on_table();
    for row in 0..=ROWS {
        for column in 1..=COLUMNS {
            let v = skirt.at(1, column, row);
            // A slope of 50 mm from the seam on, and level behind it.
            skirt.meshes.positions[v].y += 0.05 * (column as f64 / 8.0).min(1.0);
        }
    }
    let (fails, moved, words) = let_go(&skirt);
    assert!(fails.contains(&"rest_shift"), "{fails:?}");
    assert!(moved > 0.01, "{moved}");
    assert!(words.starts_with("farthest in panel \"back\" at ("), "{words}");
}

#[test]
fn cloth_without_a_body_is_not_judged() {
    let dir = tempfile::tempdir().unwrap();
    let asked = AskedFiles { body: None, ..cloth_on_table(dir.path(), &on_table()) };
    let (certificate, _) = certify(&asked).unwrap();
    let of = |name: &str| certificate.checks.iter().find(|c| c.name == name).unwrap();
    for name in ["rest_moving", "rest_shift"] {
        assert_eq!(of(name).words, "no body is known: name one with `--body`");
    }
    let (certificate, _) = certify(&AskedFiles { cloth: None, ..asked }).unwrap();
    let shift = certificate.checks.iter().find(|c| c.name == "rest_shift").unwrap();
    assert_eq!(
        shift.words,
        "forces need the fabric, which no file of a garment tells: name it with `--fabric`"
    );
}

//! What of a file is the garment: its objects without the body, buttons and what else stands there.
//!
//! Of a file of this program the cloth is taken by its names. From any file the objects go that the
//! user names, and what is closed all around beside open cloth. Cloth with a thickness is refused.

use super::closed::{Whole, list, wholes};
use super::raw::{Mended, RawMesh};
use crate::render::parts::BODY;
use toile_core::prelude::*;

/// Strips along open edges and turned copies of the cloth, as this program writes them.
const BESIDE: [(&str, &str); 2] = [(" edge", "strips along its edges"), (" wrong side", "its wrong side")];
/// Warns about another thing if it is at least this share of the largest.
const LARGE: f64 = 0.5;

/// Takes the cloth of a file that this program wrote.
pub(in crate::flat) fn cloth_of_ours(raw: &mut RawMesh, file: &str, cx: &Context) {
    if !raw.is_ours {
        return;
    }
    let names = &raw.group_names;
    let what = |group: &u32| {
        let name = names.get(*group as usize).map_or("", String::as_str);
        let of_panel =
            |end: &str| name.strip_suffix(end).is_some_and(|panel| names.iter().any(|n| n == panel));
        let is_body = name == BODY && raw.groups.iter().any(|g| g != group);
        is_body.then_some("the body").or_else(|| BESIDE.iter().find(|(end, _)| of_panel(end)).map(|b| b.1))
    };
    let left_out: Vec<Option<&str>> = raw.groups.iter().map(what).collect();
    let mut told: Vec<&str> = left_out.iter().copied().flatten().collect();
    told.sort_unstable();
    told.dedup();
    if !told.is_empty() && left_out.contains(&None) {
        cx.note(format!(
            "\"{file}\" was written by this program: the cloth is taken, without {}",
            told.join(", ")
        ));
        let is_kept: Vec<bool> = left_out.iter().map(Option::is_none).collect();
        raw.keep(&is_kept);
    }
}

/// Drops the objects that the user names.
pub(in crate::flat) fn leave_out(raw: &mut RawMesh, names: &[String], file: &str) -> Result<(), StageError> {
    if names.is_empty() {
        return Ok(());
    }
    let here =
        |k: &u32, list: &[String]| list.get(*k as usize).map_or(String::new(), |n| n.trim().to_owned());
    let groups: Vec<String> = raw.groups.iter().map(|g| here(g, &raw.group_names)).collect();
    let materials: Vec<String> = raw.materials.iter().map(|m| here(m, &raw.material_names)).collect();
    let mut known: Vec<&str> =
        groups.iter().chain(&materials).map(String::as_str).filter(|n| !n.is_empty()).collect();
    known.sort_unstable();
    known.dedup();
    if let Some(strange) = names.iter().find(|n| !known.contains(&n.trim())) {
        let e = StageError::new(
            ErrorCode::InvalidParameter,
            format!("\"{file}\" has no object, group or material \"{strange}\" to leave out"),
        );
        let hint = match known.is_empty() {
            true => "its parts have no names: export the garment alone".to_owned(),
            false => toile_core::hint(strange, "it has", &known)
                .unwrap_or_else(|| format!("it has {}", list(known.iter().copied()))),
        };
        return Err(e.hint(hint).at("leave_out"));
    }
    let is_named = |name: &String| !name.is_empty() && names.iter().any(|n| n.trim() == name);
    let is_kept: Vec<bool> =
        groups.iter().zip(&materials).map(|(g, m)| !is_named(g) && !is_named(m)).collect();
    if !is_kept.contains(&true) {
        let e = StageError::new(ErrorCode::InvalidParameter, "`leave_out` leaves nothing of the file");
        return Err(e.hint("name what is not of the garment").at("leave_out"));
    }
    raw.keep(&is_kept);
    Ok(())
}

/// Refuses cloth with a thickness, drops what is closed beside open cloth, and warns about what
/// else may be no garment.
pub(in crate::flat) fn open_cloth(mended: &mut Mended, file: &str, cx: &Context) -> Result<(), StageError> {
    let all = wholes(&mended.mesh);
    let thick: Vec<(&Whole, f64)> = all.iter().filter_map(|w| Some((w, w.thickness()?))).collect();
    if let Some((_, mm)) = thick.first().map(|(w, t)| (w, t * 1e3)) {
        let names = list(thick.iter().map(|(w, _)| w.name.as_str()));
        let what = format!(
            "\"{file}\": the cloth ({names}) has a thickness: two layers, {mm:.1} mm apart, and rims that join them"
        );
        return Err(StageError::invalid(what)
            .hint(
                "export the cloth as one layer, without thickness: in CLO and Marvelous Designer choose \"Thin\" in the OBJ export, in Blender \
                 remove the Solidify modifier",
            )
            .at("file"));
    }
    let (closed, open): (Vec<&Whole>, Vec<&Whole>) = all.iter().partition(|w| w.is_closed());
    let names = |of: &[&Whole]| list(of.iter().map(|w| w.name.as_str()));
    if open.is_empty() {
        return Ok(());
    }
    if !closed.is_empty() {
        let is = if closed.len() == 1 { "is" } else { "are" };
        cx.warn(format!(
            "{} {is} closed all around, as bodies, buttons and shoes are, and left out of the garment",
            names(&closed)
        ));
        let mut is_kept = vec![true; mended.mesh.triangles.len()];
        closed.iter().flat_map(|w| &w.triangles).for_each(|t| is_kept[*t as usize] = false);
        mended.keep(&is_kept);
    }
    let largest = open.iter().map(|w| w.size).fold(0.0, f64::max);
    let large: Vec<&Whole> = open.into_iter().filter(|w| w.size >= LARGE * largest).collect();
    let last = large.last().map_or("", |w| w.name.as_str());
    if large.len() > 1 && !last.is_empty() && large.iter().any(|w| w.name != last) {
        cx.warn(format!(
            "{} things of \"{file}\" are joined to nothing: {}; what is not of the garment is left out by its name (`--set \
             'garment.leave_out=[\"{last}\"]'`), and edges that nearly meet are sewn with a larger `weld` (`--set 'garment.weld=\"1 mm\"'`)",
            large.len(),
            names(&large)
        ));
    }
    Ok(())
}

//! One damage each, found and counted.

use super::*;
use crate::compare::{ComparedBy, compare};

#[test]
fn a_sound_skirt_holds_and_everything_is_judged() {
    let found = Skirt::new(24, 12).judged();
    assert_eq!(failing(&found), Vec::<&str>::new(), "{:?}", found.checks);
    let unjudged = found.checks.iter().filter(|c| c.verdict == Verdict::NotJudged).map(|c| c.name);
    assert_eq!(unjudged.collect::<Vec<_>>(), ["rest_moving", "rest_shift"]);
    assert!(check(&found, "strain_p99").value.unwrap() < 1e-9);
    assert_eq!(found.gaps.seams.len(), 2);
}

#[test]
fn one_crossing_pair_among_forty_thousand_triangles_is_counted_as_one() {
    let mut skirt = Skirt::new(100, 100);
    let k = 12_345;
    let t = skirt.meshes.triangles[k].map(|v| skirt.meshes.positions[v as usize].coords);
    let (centre, out) = ((t[0] + t[1] + t[2]) / 3.0, (t[1] - t[0]).cross(&(t[2] - t[0])).normalize());
    // A label whose tip goes through the inside of that triangle.
    let across = (t[1] - t[0]).normalize() * 1e-4;
    let first = skirt.meshes.positions.len() as u32;
    skirt.meshes.positions.extend(
        [centre - out * 1e-3, centre + out * 1e-2 - across, centre + out * 1e-2 + across].map(Point3::from),
    );
    skirt.meshes.triangles.push([first, first + 1, first + 2]);
    skirt.meshes.texture.push(Some([Point2::new(9.0, 0.0), Point2::new(9.01, 0.0), Point2::new(9.0, 0.01)]));
    skirt.meshes.groups.push(2);
    skirt.meshes.materials.push(0);
    skirt.meshes.names.push("label".into());
    let found = judge(&skirt.subject(None, Ok(post())), &CheckLimits::default());
    let crossings = check(&found, "self_crossings");
    assert_eq!((crossings.value, crossings.verdict), (Some(1.0), Verdict::Fails));
    assert!(crossings.words.starts_with("the first at panel \"front\" at ("), "{}", crossings.words);
    assert!(crossings.words.ends_with(", with panel \"label\""), "{}", crossings.words);
    assert_eq!(check(&found, "body_crossings").value, Some(0.0));
}

#[test]
fn a_seam_gap_of_six_tenths_of_a_millimetre_is_found() {
    let mut skirt = Skirt::new(24, 12);
    let v = skirt.at(0, 24, 6);
    skirt.meshes.positions[v].x += 6e-4;
    let found = skirt.judged();
    let gap = check(&found, "seam_gap");
    assert!((gap.value.unwrap() - 6e-4).abs() < 1e-12, "{gap:?}");
    assert_eq!(gap.verdict, Verdict::Fails);
    assert_eq!(gap.words, "seam \"front.right + back.left\" at (0.2003, 0.8500, -0.0000) m");
}

#[test]
fn a_stretched_panel_is_named() {
    let mut skirt = Skirt::new(24, 12);
    let is_back = |k: &usize| skirt.meshes.groups[*k] == 1;
    let backs: Vec<usize> = (0..skirt.meshes.triangles.len()).filter(is_back).collect();
    // Its flat piece is a tenth shorter than the cloth in space.
    for k in backs {
        for p in skirt.meshes.texture[k].iter_mut().flatten() {
            p.y *= 0.9;
        }
    }
    let found = judge(&skirt.subject(None, Ok(post())), &CheckLimits::default());
    assert_eq!(failing(&found), ["area_error", "outline_error", "strain_p99"]);
    let area = check(&found, "area_error");
    assert_eq!(area.words, "panel \"back\"");
    assert!((area.value.unwrap() - (1.0 / 0.9 - 1.0)).abs() < 1e-9, "{area:?}");
    assert!((found.panels["back"].warp_p99 - (1.0 / 0.9 - 1.0)).abs() < 1e-9);
    assert!(found.panels["front"].p99 < 1e-9);
}

#[test]
fn a_missing_triangle_a_doubled_one_and_a_turned_one_are_told_by_place() {
    let sound = Skirt::new(24, 12);
    let judged = |damage: &dyn Fn(&mut FileMeshes)| {
        let mut skirt = sound.clone();
        damage(&mut skirt.meshes);
        skirt.judged()
    };
    let found = judged(&|m| {
        m.triangles.remove(300);
        m.texture.remove(300);
        m.groups.remove(300);
        m.materials.remove(300);
    });
    assert_eq!(failing(&found), ["holes", "missing_triangles"]);
    let found = judged(&|m| {
        m.triangles[300].swap(0, 1);
        m.texture[300].iter_mut().for_each(|t| t.swap(0, 1));
    });
    assert!(failing(&found).contains(&"turned_triangles"), "{:?}", failing(&found));
    assert!(check(&found, "turned_triangles").words.starts_with("the first at panel \"front\" at ("));
    let found = judged(&|m| {
        m.triangles.push(m.triangles[300]);
        m.texture.push(m.texture[300]);
        m.groups.push(0);
        m.materials.push(0);
    });
    assert_eq!(check(&found, "doubled_triangles").value, Some(1.0));
    let found = judged(&|m| m.triangles[300][0] = m.triangles[300][1]);
    assert_eq!(check(&found, "degenerate_triangles").value, Some(1.0));
}

#[test]
fn cloth_in_the_body_is_found_where_nothing_crosses() {
    // All of the skirt is inside: no triangle crosses the skin.
    let mut skirt = Skirt::new(24, 12);
    for p in &mut skirt.meshes.positions {
        (p.x, p.z) = (p.x * 0.5, p.z * 0.5);
    }
    let found = skirt.judged();
    assert_eq!(check(&found, "body_crossings").value, Some(0.0));
    let depth = check(&found, "body_depth");
    assert_eq!(depth.verdict, Verdict::Fails);
    assert!(depth.value.unwrap() > 0.04, "{depth:?}");
}

#[test]
fn what_cannot_be_judged_says_why() {
    let mut skirt = Skirt::new(24, 12);
    skirt.meshes.texture.iter_mut().for_each(|t| *t = None);
    let none = Err("no body is known: name one with `--body`".to_owned());
    let found = judge(&skirt.subject(None, none), &CheckLimits::default());
    assert!(found.holds());
    let words = |name: &str| check(&found, name).words.clone();
    assert_eq!(words("seam_gap"), "no pattern was given: name one with `--pattern`");
    assert_eq!(words("body_crossings"), "no body is known: name one with `--body`");
    assert_eq!(
        words("strain_p99"),
        "the flat shape is not known: the garment's file has no texture points on all triangles"
    );
    let judged: Vec<_> =
        found.checks.iter().filter(|c| c.verdict == Verdict::Holds).map(|c| c.name).collect();
    assert_eq!(
        judged,
        [
            "files",
            "degenerate_triangles",
            "doubled_triangles",
            "turned_triangles",
            "missing_triangles",
            "self_crossings"
        ]
    );
}

#[test]
fn a_pattern_of_another_garment_is_refused() {
    let skirt = Skirt::new(24, 12);
    let mut other = pattern(24);
    for piece in &mut other.pieces {
        piece.outer.corners[2] = Point2::new(0.3, 0.3);
    }
    let found = judge(&skirt.subject(Some(&other), Ok(post())), &CheckLimits::default());
    assert_eq!(failing(&found), ["panels_off_pattern"]);
    assert_eq!(
        check(&found, "panels_off_pattern").words,
        "no panel has the shape of a piece of the pattern: the texture is not the flat shape, or the pattern is another garment's"
    );
}

#[test]
fn a_texture_in_any_scale_is_the_flat_shape_where_a_pattern_says_so() {
    let mut skirt = Skirt::new(24, 12);
    for p in skirt.meshes.texture.iter_mut().flatten().flatten() {
        *p = Point2::new(0.37 * -p.y + 0.1, 0.37 * p.x);
    }
    // Both pieces are one rectangle: only their seams show which panel lies on which.
    skirt.meshes.names = vec![String::new(), String::new()];
    let found = skirt.judged();
    assert_eq!(failing(&found), Vec::<&str>::new(), "{:?}", found.checks);
    assert!(check(&found, "outline_deviation").value.unwrap() < 1e-6);
}

#[test]
fn a_moved_vertex_is_found_beside_a_second_garment() {
    let sound = Skirt::new(24, 12);
    let mut moved = sound.clone();
    let v = moved.at(1, 10, 5);
    moved.meshes.positions[v].y += 3e-4;
    let none = || Err("no body".to_owned());
    let [a, b] = [&sound, &moved].map(|s| s.subject(None, none()).garment);
    let difference = compare(&a, &b);
    let (name, worst) = difference.worst().unwrap();
    assert_eq!((name, worst.by), ("back", ComparedBy::Vertices));
    assert!((worst.max_m - 3e-4).abs() < 1e-12 && worst.p99_m < 1e-12, "{worst:?}");
    assert_eq!(Point3::from(worst.at), sound.meshes.positions[v]);
    assert_eq!(difference.panels["front"].max_m, 0.0);
    // Meshes of other triangles are compared by their surfaces.
    let finer = Skirt::new(48, 24).subject(None, none()).garment;
    let between = compare(&a, &finer);
    let worst = between.worst().unwrap().1;
    assert!(worst.by == ComparedBy::Surfaces && worst.max_m < 1e-3 && worst.max_m > 1e-5, "{worst:?}");
}

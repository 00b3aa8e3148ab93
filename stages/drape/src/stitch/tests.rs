//! A vest is sewn around a torso; what cannot be sewn is named.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::SpringStitcher;
use crate::drape::SpringSewing;
use std::path::Path;
use std::sync::{Arc, Mutex};
use toile_core::prelude::*;
use toile_core::{Cancel, Event, Listener};
use toile_fixtures::cloth::{Capsules, ClothGrid, garment, plain, vest};

fn sew(g: &Garment, body: Option<&Collider>) -> Result<Garment, StageError> {
    SpringStitcher::default().run(g, body, &Context::quiet())
}

/// Two sheets 20 cm wide before and behind a body, sewn along both sides.
fn tube(depth: f64, fabric: &Arc<Fabric>) -> Garment {
    const SIZE: (usize, usize) = (12, 8);
    let grid = |lift| ClothGrid {
        columns: SIZE.0,
        rows: SIZE.1,
        flat: |u, v| Point2::new(0.2 * (u - 0.5), 0.12 * (v - 0.5)),
        lift,
    };
    let (front, back) = (grid(|p| Point3::new(p.x, p.y, 1.0)), grid(|p| Point3::new(-p.x, p.y, -1.0)));
    let mut g = garment(&[("front", &front), ("back", &back)], fabric);
    g.positions.iter_mut().for_each(|p| p.z *= depth);
    let shift = g.panels[1].vertices.start as u32;
    for (name, column) in [("left", SIZE.0), ("right", 0)] {
        let pair = |r| [front.at(column, r), back.at(SIZE.0 - column, r) + shift];
        g.seams.push(GarmentSeam {
            name: format!("front.{name} + back.{name}"),
            kind: SeamKind::Matched,
            pairs: (0..=SIZE.1).map(pair).collect(),
            state: SeamState::Open,
        });
    }
    g
}

fn pole(radius: f64) -> Collider {
    Capsules::new(&[([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], radius)]).collider()
}

#[test]
fn a_vest_is_sewn_around_a_torso() {
    let sewn = sew(&vest(&plain(6000.0, 80.0, 1e-5)), Some(&Capsules::torso().collider())).unwrap();
    assert!(sewn.seams.iter().all(|s| s.state == SeamState::Closed));
    for p in sewn.seams.iter().flat_map(|s| &s.pairs) {
        let [a, b] = p.map(|i| i as usize);
        // Bit by bit: joined vertices are one node.
        assert_eq!((sewn.positions[a], sewn.velocities[a]), (sewn.positions[b], sewn.velocities[b]));
    }
    let body = Capsules::torso();
    let deepest = sewn.positions.iter().map(|p| body.distance(p).0).fold(f64::INFINITY, f64::min);
    assert!(deepest > 1e-3, "{deepest}");
    let strains = sewn.edge_strains();
    assert!(strains[strains.len() * 99 / 100] < 0.03);
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let g = vest(&plain(6000.0, 80.0, 1e-5));
    let body = Capsules::torso().collider();
    let stage = SpringStitcher::default();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| stage.run(&g, Some(&body), &Context::quiet())).unwrap()
    };
    let (one, two) = (with(1), with(2));
    assert_eq!(one.positions, two.positions);
    assert_eq!(one.velocities, two.velocities);
    assert_eq!(one.status, two.status);
}

#[test]
fn a_gathered_seam_is_sewn_as_well() {
    // The back is a third longer, with as many vertices: it is gathered evenly.
    let mut g = tube(0.02, &plain(2000.0, 50.0, 1e-5));
    for i in g.panels[1].vertices.clone() {
        g.rest[i].y *= 1.33;
        g.positions[i].y *= 1.33;
    }
    g.seams.iter_mut().for_each(|s| s.kind = SeamKind::Gathered);
    let sewn = sew(&g, None).unwrap();
    assert!(sewn.seams.iter().all(|s| s.state == SeamState::Closed));
    assert_eq!(sewn.seam_gap_max(), 0.0);
}

#[test]
fn sewing_without_a_body_needs_no_collider() {
    let sewn = sew(&tube(0.03, &plain(2000.0, 50.0, 1e-5)), None).unwrap();
    assert_eq!(sewn.seam_gap_max(), 0.0);
    assert!(sewn.status.steps > 0);
}

#[test]
fn a_body_too_wide_for_the_panels_is_named_with_the_gap() {
    let e = sew(&tube(0.16, &plain(6000.0, 80.0, 1e-5)), Some(&pole(0.15))).unwrap_err();
    assert_eq!(e.code, ErrorCode::StitchingError);
    assert!(
        e.message.starts_with("the seam from front.") && e.message.contains(" stays open by 24 cm after ")
    );
    assert_eq!(
        e.hint.as_deref(),
        Some(
            "place its pieces nearer, with nothing between its sides, cut them wider, or sew with \
             `StaticEquilibrium(sew_through: true)`"
        )
    );
}

fn stopped_after(time_limit: f64) -> SpringStitcher {
    SpringStitcher { sewing: SpringSewing { time_limit, ..SpringSewing::default() } }
}

#[test]
fn a_seam_that_is_open_at_the_limit_of_time_is_named() {
    let stage = stopped_after(0.01);
    let e = stage.run(&tube(0.05, &plain(2000.0, 50.0, 1e-5)), None, &Context::quiet()).unwrap_err();
    assert_eq!(e.code, ErrorCode::StitchingError);
    assert_eq!(
        e.message,
        "the seam from front.right to back.right stays open by 9.4 cm after 0.01 s of sewing"
    );
    assert_eq!(e.hint.as_deref(), Some("sew for longer: `--set 'stages.test.time_limit=0.5'`"));
    assert_eq!(
        e.detail.as_deref(),
        Some("seam 'front.right + back.right' stays open by 93.7 mm after 0.01 s")
    );
    let longer = stopped_after(0.5);
    assert!(
        longer.run(&tube(0.05, &plain(2000.0, 50.0, 1e-5)), None, &Context::quiet()).is_ok(),
        "the help helps"
    );
}

#[test]
fn a_start_deep_in_the_body_is_refused() {
    let e = sew(&tube(0.0, &plain(2000.0, 50.0, 1e-5)), Some(&pole(0.1))).unwrap_err();
    assert_eq!(e.code, ErrorCode::InvalidInput);
    assert_eq!(e.message, "'front' starts inside the body, by 10 cm at (0.000, -0.060, 0.000) m");
}

#[test]
fn a_shallow_start_is_moved_out() {
    let body = pole(0.04);
    let sewn = sew(&tube(0.03, &plain(2000.0, 50.0, 1e-5)), Some(&body)).unwrap();
    let mut inside = Vec::new();
    body.scheme.body_contacts(&sewn.positions, 0.0, &mut inside);
    assert!(inside.is_empty(), "{}", inside.len());
}

#[test]
fn a_bad_garment_is_refused_before_anything_moves() {
    let mut g = tube(0.03, &plain(2000.0, 50.0, 1e-5));
    g.positions[7].x = f64::INFINITY;
    assert_eq!(
        sew(&g, None).unwrap_err().message,
        "a point of panel \"front\" has a coordinate that is not a finite number"
    );
}

#[test]
fn it_stops_on_request() {
    let cancel = Cancel::new();
    cancel.cancel();
    let cx = Context::new("test", Path::new("."), cancel, Arc::new(()));
    let e = SpringStitcher::default().run(&tube(0.05, &plain(2000.0, 50.0, 1e-5)), None, &cx).unwrap_err();
    assert_eq!(e.code, ErrorCode::Cancelled);
}

/// Keeps the texts of the progress that it hears of.
#[derive(Default)]
struct Ears(Mutex<Vec<String>>);

impl Listener for Ears {
    fn event(&self, _: &str, _: &str, event: &Event) {
        if let Event::Progress { text, .. } = event {
            self.0.lock().unwrap().push(text.clone());
        }
    }
}

#[test]
fn progress_tells_time_and_gap() {
    let ears = Arc::new(Ears::default());
    let cx = Context::new("test", Path::new("."), Cancel::new(), ears.clone());
    SpringStitcher::default().run(&tube(0.1, &plain(2000.0, 50.0, 1e-5)), None, &cx).unwrap();
    let texts = ears.0.lock().unwrap();
    assert_eq!(texts[0], "sewing: widest seam 197.9 mm; 0.00 s of at most 4 s");
}

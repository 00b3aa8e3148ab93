#![allow(clippy::unwrap_used, clippy::panic)]
use super::*;
use std::collections::BTreeSet;

/// Every second decade of time step, every decade of stiffness, the coarsest sheet.
fn small(schemes: &[Scheme]) -> Map {
    let options =
        Options { schemes: schemes.to_vec(), cells: 9, along: vec![4], longest: 0.2, ..Options::default() };
    map(&options, &mut |_, _| ControlFlow::Continue(())).unwrap()
}

/// The last time step that converges and the first that does not, s, of a row where both ran.
fn border(row: &[Cell]) -> Option<[f64; 2]> {
    let holds = |c: &&Cell| c.outcome == Outcome::Converges;
    let last = row.iter().rfind(holds)?.dt?;
    let first = row.iter().find(|c| c.dt > Some(last))?.dt?;
    Some([last, first])
}

fn rows(map: &Map, scheme: Scheme) -> Vec<&[Cell]> {
    let is_row = |a: &Cell, b: &Cell| a.stiffness.to_bits() == b.stiffness.to_bits() && a.scheme == b.scheme;
    map.cells.chunk_by(is_row).filter(|row| row[0].scheme == scheme).collect()
}

#[test]
fn explicit_steps_end_at_their_theoretical_limit() {
    let map = small(&[Scheme::Explicit, Scheme::Unguarded]);
    for scheme in [Scheme::Explicit, Scheme::Unguarded] {
        let mut seen = 0;
        for row in rows(&map, scheme) {
            let Some([last, first]) = border(row) else { continue };
            let limit = row[0].limit;
            // The sheet stiffens a little in its swing, so the border may lie just under the limit
            // of the start.
            assert!(
                last < limit && limit < 1.1 * first,
                "{scheme:?}: {last:e} to {first:e}, limit {limit:e}"
            );
            seen += 1;
        }
        assert!(seen >= 4, "{scheme:?}: {seen} rows have a border");
    }
    let above = |c: &&Cell| c.dt > Some(1.1 * c.limit);
    for cell in map.cells.iter().filter(above) {
        match (cell.scheme, &cell.outcome) {
            (Scheme::Explicit, Outcome::Refused { error_name, error_text }) => {
                assert_eq!(error_name, "TimeStepUnstable");
                let (dt, limit) = (cell.dt.unwrap(), cell.limit);
                let words =
                    format!("time step {dt:.3e} s is unstable: the limit 2/omega_max is {limit:.3e} s");
                assert_eq!(error_text, &words);
            }
            (Scheme::Unguarded, Outcome::Drifts | Outcome::TooLong) => {}
            other => panic!("{other:?} at {:?}", cell.dt),
        }
    }
}

#[test]
fn solvers_without_a_limit_refuse_nothing() {
    let free = [Scheme::Implicit, Scheme::Gradients, Scheme::Xpbd, Scheme::Projective, Scheme::Rest];
    let map = small(&free);
    let schemes: BTreeSet<&str> = map.cells.iter().map(|c| c.scheme.key()).collect();
    assert_eq!(schemes.len(), free.len());
    for cell in &map.cells {
        assert!(!matches!(cell.outcome, Outcome::Refused { .. }), "{cell:?}");
    }
    // Backward Euler is right wherever it ran, far above the explicit limit.
    let implicit = [Scheme::Implicit, Scheme::Gradients];
    let ran = |c: &&Cell| implicit.contains(&c.scheme) && c.outcome != Outcome::TooLong;
    assert!(map.cells.iter().filter(ran).count() >= 30);
    for cell in map.cells.iter().filter(ran) {
        assert!(cell.outcome == Outcome::Converges && cell.error.unwrap() < 1e-3, "{cell:?}");
    }
}

#[test]
fn quickest_cells_keep_the_error_and_nothing_quicker_does() {
    let map = small(&[Scheme::Implicit, Scheme::Xpbd]);
    assert_eq!(map.quickest.len(), 2 * map.stiffnesses.len());
    let found = map.quickest.iter().filter_map(|q| Some((q, q.best?)));
    for (q, best) in found {
        assert!(best.error <= map.keep);
        let rivals = map.cells.iter().filter(|c| c.scheme == q.scheme && c.stiffness == q.stiffness);
        let quicker = |c: &&Cell| c.outcome == Outcome::Converges && c.seconds < best.seconds;
        assert!(rivals.filter(quicker).all(|c| c.error.unwrap() > map.keep));
    }
    assert!(map.quickest.iter().filter(|q| q.best.is_some()).count() > map.stiffnesses.len());
}

#[test]
fn every_cell_is_a_line_of_the_csv() {
    let map = small(&[Scheme::Explicit, Scheme::Rest]);
    let csv = map.to_csv();
    let lines: Vec<Vec<&str>> = csv.lines().map(|l| l.split(',').collect()).collect();
    assert_eq!(lines.len(), 1 + 9 * 9 + 9);
    assert!(lines.iter().all(|l| l.len() == 11));
    assert_eq!(
        csv.lines().next(),
        Some(
            "solver,edge_m,stiffness_n_per_m,dt_s,explicit_limit_s,outcome,error_lengths,speed_m_s,steps,cpu_s,refused_as"
        )
    );
    let refused = lines.iter().filter(|l| l[5] == "refused" && l[10] == "TimeStepUnstable").count();
    assert!(refused > 20, "{refused}");
    assert!(lines.iter().filter(|l| l[0] == "rest").all(|l| l[3].is_empty()));
    assert!(map.to_json().contains("\"error_name\": \"TimeStepUnstable\""));
    assert!(map.to_string().contains("| 1e-1 s | 2/omega_max |"));
}

#[test]
fn a_caller_can_stop_between_cells() {
    let mut heard = 0;
    let stopped = map(&Options::default(), &mut |share, what| {
        assert!(
            (0.0..1.0).contains(&share)
                && what.starts_with("central differences, edge ")
                && what.contains(" mm, 1.000 N/m, step ")
        );
        heard += 1;
        if heard > 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })
    .unwrap();
    assert!(stopped.stopped && stopped.cells.len() == 2);
    // Where a cell itself is stopped it is left out.
    let schemes = vec![Scheme::Implicit, Scheme::Rest];
    let options = Options { schemes, stop: || true, cells: 2, along: vec![4], ..Options::default() };
    let stopped = map(&options, &mut |_, _| ControlFlow::Continue(())).unwrap();
    assert!(stopped.stopped && stopped.cells.iter().all(|c| c.outcome == Outcome::TooLong));
}

//! Fits the weights of the scores to the tuned half of the files.
//!
//!     TOILE_SHARED=... cargo test --release -p toile-pattern --lib weights_are_fitted -- \
//!         --ignored --nocapture
//!
//! Method: a conditional logit with a small penalty, by Newton's method (McFadden 1974): every free
//! edge, and every stretch, chooses its partner or none, in states of the garment in which a part
//! of the true seams, by lot, is sewn already. Prints the constants.

use super::super::border::Border;
use super::super::score::Pair;
use super::super::sheet::Sheet;
use super::super::{around, score};
use super::cases::{Case, Lot, cases, is_tuned};
use std::collections::BTreeSet;
use toile_core::prelude::*;

/// Pulls weights towards nothing.
const PENALTY: f64 = 0.5;
/// Steps of Newton's method.
const STEPS: usize = 14;

/// The partners that an edge or a stretch may have, and the number of the right one, if any is.
struct Choice<const N: usize> {
    partners: Vec<[f64; N]>,
    right: Option<usize>,
    weight: f64,
}

/// The weights that make the right choices likeliest; those of `fixed` stay 0.
fn fitted<const N: usize>(choices: &[Choice<N>], fixed: &[usize]) -> [f64; N] {
    let mut w = [0.0; N];
    for _ in 0..STEPS {
        let mut slope = [0.0; N];
        let mut bend = vec![[0.0; N]; N];
        for c in choices {
            let odds =
                c.partners.iter().map(|x| x.iter().zip(&w).map(|(a, b)| a * b).sum::<f64>().min(30.0).exp());
            let odds: Vec<f64> = odds.collect();
            let all = 1.0 + odds.iter().sum::<f64>();
            let mut mean = [0.0; N];
            for (x, o) in c.partners.iter().zip(&odds).filter(|(_, o)| **o > 1e-6 * all) {
                let p = o / all;
                for i in 0..N {
                    mean[i] += p * x[i];
                    for j in 0..=i {
                        bend[i][j] += c.weight * p * x[i] * x[j];
                    }
                }
            }
            for i in 0..N {
                slope[i] += c.weight * (c.right.map_or(0.0, |r| c.partners[r][i]) - mean[i]);
                for j in 0..=i {
                    bend[i][j] -= c.weight * mean[i] * mean[j];
                }
            }
        }
        for i in 0..N {
            slope[i] -= PENALTY * w[i];
            bend[i][i] += PENALTY;
            if fixed.contains(&i) {
                slope[i] = 0.0;
            }
        }
        let step = solved(bend, slope);
        (0..N).filter(|i| !fixed.contains(i)).for_each(|i| w[i] += step[i].clamp(-2.0, 2.0));
    }
    w
}

/// The solution of a symmetric system of which the lower half is given, by Cholesky's method.
fn solved<const N: usize>(mut l: Vec<[f64; N]>, mut x: [f64; N]) -> [f64; N] {
    for j in 0..N {
        let own: f64 = (0..j).map(|k| l[j][k] * l[j][k]).sum();
        l[j][j] = (l[j][j] - own).max(1e-9).sqrt();
        for i in j + 1..N {
            let own: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            l[i][j] = (l[i][j] - own) / l[j][j];
        }
    }
    for i in 0..N {
        let own: f64 = (0..i).map(|k| l[i][k] * x[k]).sum();
        x[i] = (x[i] - own) / l[i][i];
    }
    for i in (0..N).rev() {
        let own: f64 = (i + 1..N).map(|k| l[k][i] * x[k]).sum();
        x[i] = (x[i] - own) / l[i][i];
    }
    x
}

/// The true seams as edges of the sheet, and as pairs of exchangeable edges.
fn truth(case: &Case, sheet: &Sheet) -> (Vec<[Vec<usize>; 2]>, BTreeSet<[usize; 2]>) {
    let at = |u: &EdgeUse| {
        let i = case.pieces.iter().position(|p| p.name == u.edge.panel).unwrap();
        let k = case.pieces[i].edge_number(&u.edge.edge).unwrap();
        sheet.edges.iter().position(|e| e.piece == i && e.number == k).unwrap()
    };
    let two = case.seams.iter().filter(|s| s.sides.len() == 2);
    let all: Vec<[Vec<usize>; 2]> =
        two.map(|s| [0, 1].map(|k| s.sides[k].iter().map(at).collect())).collect();
    let alike = all.iter().filter(|[a, b]| a.len() == 1 && b.len() == 1).map(|[a, b]| {
        let mut pair = [sheet.alike[a[0]], sheet.alike[b[0]]];
        pair.sort_unstable();
        pair
    });
    let alike = alike.collect();
    (all, alike)
}

fn is_true(sheet: &Sheet, alike: &BTreeSet<[usize; 2]>, a: usize, b: usize) -> bool {
    let mut pair = [sheet.alike[a], sheet.alike[b]];
    pair.sort_unstable();
    alike.contains(&pair)
}

/// The choices of a case in some states.
fn choices(
    case: &Case,
    pairs: &mut Vec<Choice<{ score::FEATURES }>>,
    around: &mut Vec<Choice<{ around::FEATURES }>>,
) {
    let sheet = Sheet::of(&case.pieces);
    let (seams, alike) = truth(case, &sheet);
    let all = score::pairs(&sheet, super::super::SHORTEST);
    let length = |s: &[usize]| s.iter().map(|e| sheet.edges[*e].length).sum::<f64>();
    let mut lot = Lot::of(&case.name);
    // A garment of many panels counts for not much more than one of few.
    let weight = (60.0 / sheet.edges.len() as f64).min(1.0);
    for state in 0..5 {
        let mut border = Border::of(&sheet);
        for [a, b] in &seams {
            let eased = (length(a) / length(b)).ln().abs();
            let first = match state {
                0 => false,
                // What has nearly equal lengths and is no waist.
                3 | 4 => {
                    let level = |s: &[usize]| sheet.edges[s[0]].out.x.abs();
                    eased < 0.02 && (level(a).max(level(b)) > 0.6 || lot.below(3) == 0)
                }
                _ => lot.below(3) < state,
            };
            if first {
                border.sew(&sheet, a, b);
            }
        }
        let rivals = score::rivals(&sheet, &border, &all);
        let mut of: Vec<Vec<&Pair>> = vec![Vec::new(); sheet.edges.len()];
        for p in all.iter().filter(|p| border.free[p.a] && border.free[p.b]) {
            of[p.a].push(p);
            of[p.b].push(p);
        }
        for (e, own) in of.iter_mut().enumerate().filter(|(_, o)| !o.is_empty()) {
            own.sort_by(|x, y| x.ratio.total_cmp(&y.ratio));
            let (mut seen, mut partners, mut right) = (BTreeSet::new(), Vec::new(), None);
            for p in own.iter() {
                let other = p.a + p.b - e;
                let is_right = is_true(&sheet, &alike, e, other);
                if seen.insert(sheet.alike[other]) && (partners.len() < 30 || is_right) {
                    if is_right && right.is_none() {
                        right = Some(partners.len());
                    }
                    partners.push(score::features(&sheet, &border, &rivals, p));
                }
            }
            pairs.push(Choice { partners, right, weight });
        }
        let stretches = around::stretches(&border);
        for i in 0..stretches.len() {
            let (mut partners, mut right) = (Vec::new(), None);
            for j in (0..stretches.len()).filter(|j| *j != i) {
                let Some(laid) = around::laid(&sheet, &border, &stretches[i], &stretches[j]) else {
                    continue;
                };
                let whole: f64 = laid.parts.iter().map(|[x, _]| length(x)).sum();
                let own = laid.parts.iter().map(|[x, y]| met(&sheet, &alike, x, y)).sum::<f64>();
                if own >= 0.8 * whole && right.is_none() {
                    right = Some(partners.len());
                }
                if own < 0.8 * whole || right == Some(partners.len()) {
                    partners.push(laid.features);
                }
            }
            around.push(Choice { partners, right, weight });
        }
    }
}

/// The length of one side over which the truth sews it to the other as it is laid.
fn met(sheet: &Sheet, alike: &BTreeSet<[usize; 2]>, a: &[usize], b: &[usize]) -> f64 {
    let total = |s: &[usize]| s.iter().map(|e| sheet.edges[*e].length).sum::<f64>().max(1e-9);
    let place = |s: &[usize], share: f64| {
        let mut left = share * total(s);
        let at = s.iter().find(|e| {
            let inside = left < sheet.edges[**e].length;
            left -= sheet.edges[**e].length;
            inside
        });
        at.copied().unwrap_or(s[s.len() - 1])
    };
    let b: Vec<usize> = b.iter().rev().copied().collect();
    let right = (0..20).filter(|k| {
        let share = (f64::from(*k) + 0.5) / 20.0;
        is_true(sheet, alike, place(a, share), place(&b, share))
    });
    right.count() as f64 / 20.0 * total(a)
}

fn print(name: &str, w: &[f64]) {
    let numbers: Vec<String> = w.iter().map(|x| format!("{x:.3}")).collect();
    println!("{name}: [{}]", numbers.join(", "));
}

#[test]
#[ignore = "slow: .ci/wide"]
fn weights_are_fitted() {
    let Some(cases) = cases() else {
        println!("skipped: TOILE_SHARED is not set");
        return;
    };
    let (mut pairs, mut around) = (Vec::new(), Vec::new());
    for case in cases.iter().filter(|c| is_tuned(&c.name)) {
        choices(case, &mut pairs, &mut around);
    }
    let told = |all: usize, right: usize| println!("{all} choices, {right} with a right one");
    told(pairs.len(), pairs.iter().filter(|c| c.right.is_some()).count());
    let mut w = fitted(&pairs, &[score::FEATURES - 1]);
    w[score::FEATURES - 1] = 1.5;
    print("pairs", &w);
    told(around.len(), around.iter().filter(|c| c.right.is_some()).count());
    let a = fitted(&around, &[]);
    print("stretches", &a);
    // A fit that says nothing would leave the weights at 0.
    assert!(w[1..].iter().any(|x| x.abs() > 0.5) && a[1..].iter().any(|x| x.abs() > 0.5));
}

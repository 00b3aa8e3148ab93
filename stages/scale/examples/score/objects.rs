//! The objects, and things that are like them, as things to lay.

use crate::random::Random;
use crate::thing::{Look, Outline, Thing};

fn thing(a: f64, b: f64, radius: f64, look: Look, thick: f64) -> Thing {
    Thing { outline: Outline::Box(a / 2.0, b / 2.0, radius), look, x: 0.0, y: 0.0, turn: 0.0, thick }
}

fn apart(r: &mut Random, from: [f64; 3], least: f64) -> [f64; 3] {
    loop {
        let c = r.colour(15.0, 245.0);
        if (0..3).map(|i| (c[i] - from[i]).powi(2)).sum::<f64>().sqrt() > least {
            return c;
        }
    }
}

pub fn card(r: &mut Random, ground: [f64; 3]) -> Thing {
    let base = apart(r, ground, 40.0);
    let other = apart(r, base, 60.0);
    thing(0.0856, 0.05398, 0.00318, Look::Print(base, other, r.below(16) as u64), 0.0008)
}

fn paper(r: &mut Random, ground: [f64; 3]) -> [f64; 3] {
    let v = r.from(205.0, 240.0);
    let white = [v, v, v - r.from(0.0, 12.0)];
    let far = (0..3).map(|i| (white[i] - ground[i]).powi(2)).sum::<f64>().sqrt();
    if far > 40.0 { white } else { [v - 90.0, v - 80.0, v - 40.0] }
}

pub fn a4(r: &mut Random, ground: [f64; 3]) -> Thing {
    let base = paper(r, ground);
    thing(0.297, 0.21, 0.0, Look::Paper(base, r.below(4) as u64), 0.0002)
}

pub fn letter(r: &mut Random, ground: [f64; 3]) -> Thing {
    let base = paper(r, ground);
    thing(0.2794, 0.2159, 0.0, Look::Paper(base, r.below(4) as u64), 0.0002)
}

pub fn chess(r: &mut Random, ground: [f64; 3]) -> Thing {
    let light = paper(r, ground);
    let dark = r.from(15.0, 60.0);
    let look = Look::Chess { square: 0.025, columns: 10, rows: 7, dark: [dark; 3], light };
    thing(0.28, 0.205, 0.0, look, 0.0002)
}

pub fn ruler(r: &mut Random, ground: [f64; 3], fine: bool, long: f64) -> Thing {
    let choices = [[235.0, 235.0, 230.0], [225.0, 195.0, 80.0], [190.0, 192.0, 195.0], [210.0, 175.0, 130.0]];
    let far = |c: &[f64; 3]| (0..3).map(|i| (c[i] - ground[i]).powi(2)).sum::<f64>().sqrt();
    let mut base = choices[r.below(4)];
    if far(&base) < 40.0 {
        base = choices.into_iter().max_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(base);
    }
    let ink = r.from(15.0, 60.0);
    thing(long, r.from(0.025, 0.038), 0.001, Look::Ruler { base, ink: [ink; 3], fine }, 0.001)
}

/// A thing that is none of the objects: phone, business card, book, postcard, label, square.
pub fn decoy(r: &mut Random, ground: [f64; 3], which: usize) -> Thing {
    let base = apart(r, ground, 40.0);
    let other = apart(r, base, 60.0);
    let print = Look::Print(base, other, r.below(16) as u64);
    match which % 6 {
        0 => thing(0.147, 0.0715, 0.009, print, 0.003),
        1 => thing(0.085, 0.055, 0.0, print, 0.0004),
        2 => thing(0.198, 0.129, 0.0, print, 0.004),
        3 => thing(0.148, 0.100, 0.0, print, 0.0003),
        4 => thing(0.07, 0.045, 0.0, print, 0.0003),
        _ => thing(0.1, 0.1, 0.0, print, 0.0003),
    }
}
pub const DECOYS: [&str; 6] = ["phone", "business card", "book", "postcard", "label", "square"];

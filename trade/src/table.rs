//! What was measured as lines of text: a table for people, comma-separated values for programs.

use crate::digits::to_digits;
use crate::knobs::slot::setting_words;
use crate::record::{
    Clock, Measured, NeighbourLevels, Order, OwnSpread, Point, ReferenceLevel, SettingOutcome, Trade,
};
use crate::reference::floor::Floor;
use crate::reference::richardson::FORMAL_ORDER;
use std::fmt::Write;

/// A column: its head, its unit, and its value.
type Column = (&'static str, fn(&Measured) -> Option<f64>);

/// Every figure of a setting, in the order of the file.
const COLUMNS: [Column; 23] = [
    ("wall_s", |m| Some(m.time(Clock::Wall))),
    ("wall_spread_s", |m| Some(m.time_spread(Clock::Wall))),
    ("cpu_s", |m| Some(m.time(Clock::Cpu))),
    ("cpu_spread_s", |m| Some(m.time_spread(Clock::Cpu))),
    ("peak_memory_mb", |m| m.peak_memory_bytes.map(|b| b as f64 / 1e6)),
    ("triangles", |m| Some(m.triangles as f64)),
    ("distance_mean_mm", |m| Some(m.errors.distance_mm.mean)),
    ("distance_p95_mm", |m| Some(m.errors.distance_mm.p95)),
    ("distance_max_mm", |m| Some(m.errors.distance_mm.max)),
    ("displacement_mean_mm", |m| Some(m.errors.displacement_mm.mean)),
    ("displacement_p95_mm", |m| Some(m.errors.displacement_mm.p95)),
    ("displacement_max_mm", |m| Some(m.errors.displacement_mm.max)),
    ("ease_bust_mm", |m| m.errors.ease_mm.get("bust").copied()),
    ("ease_waist_mm", |m| m.errors.ease_mm.get("waist").copied()),
    ("ease_hip_mm", |m| m.errors.ease_mm.get("hip").copied()),
    ("seam_gap_mm", |m| Some(m.errors.seam_gap_mm)),
    ("area_pp", |m| Some(m.errors.area_pp)),
    ("outline_pp", |m| Some(m.errors.outline_pp)),
    ("strain_p99_pp", |m| Some(m.errors.strain_p99_pp)),
    ("silhouette_front", |m| Some(m.errors.silhouette_front)),
    ("silhouette_side", |m| Some(m.errors.silhouette_side)),
    ("texture_levels", |m| m.errors.texture_levels),
    ("runs", |m| Some(m.wall_s.len() as f64)),
];

/// More than any figure is good for.
const DIGITS: usize = 6;

/// All settings as comma-separated values, a head line first; empty where a figure is not known.
pub fn csv(trade: &Trade) -> String {
    let heads: Vec<&str> = COLUMNS.iter().map(|(head, _)| *head).collect();
    let keys = keys(trade);
    let mut text = format!("point,front,outcome,sound,{},{}\n", heads.join(","), keys.join(","));
    for (i, p) in trade.points.iter().enumerate() {
        let m = p.measured();
        let outcome = match &p.outcome {
            SettingOutcome::Measured(_) => "measured".to_owned(),
            SettingOutcome::Failed { code, .. } => code.clone(),
            SettingOutcome::OverLimit { .. } => "over_limit".to_owned(),
        };
        let figure =
            |(_, of): &Column| m.and_then(of).map_or_else(String::new, |x| to_digits(x, DIGITS).to_string());
        let figures: Vec<String> = COLUMNS.iter().map(figure).collect();
        let values: Vec<String> = keys.iter().map(|k| quoted(p.setting.get(*k))).collect();
        let sound = m.map_or("", |m| if m.sound { "true" } else { "false" });
        let _ = writeln!(
            text,
            "{},{},{outcome},{sound},{},{}",
            i + 1,
            trade.front.contains(&i),
            figures.join(","),
            values.join(",")
        );
    }
    text
}

/// This session's knobs, then those that only settings of earlier ones have.
fn keys(trade: &Trade) -> Vec<&str> {
    let now = trade.knobs.iter().map(|k| &k.key);
    let mut keys: Vec<&str> = Vec::new();
    for key in now.chain(trade.points.iter().flat_map(|p| p.setting.keys())) {
        if !keys.contains(&key.as_str()) {
            keys.push(key);
        }
    }
    keys
}

fn quoted(value: Option<&String>) -> String {
    let bare = value.map_or("", |v| v.trim_matches('"'));
    if bare.contains([',', '"', '\n']) {
        format!("\"{}\"", bare.replace('"', "\"\""))
    } else {
        bare.to_owned()
    }
}

/// The reference and the settings as lines; the front is marked with a star. `only_front` leaves
/// out all else.
pub fn lines(trade: &Trade, only_front: bool) -> Vec<String> {
    let mut lines = reference(trade);
    lines.push(String::new());
    lines.push(format!(
        "{:>4} {:>9} {:>7} {:>9} {:>6} | {:>6} {:>6} {:>6} {:>6} | {:>6} {:>6} {:>6} | {:>5} {:>5} {:>5} {:>6} | {:>6} {:>6} {:>5}  {}",
        "", "wall s", "spread", "cpu s", "MB", "mean", "95 %", "worst", "displ", "bust", "waist", "hip", "gap", "area",
        "outl", "strain", "front", "side", "tex", "setting"
    ));
    let shown = |i: &usize| !only_front || trade.front.contains(i);
    let order = by_time(trade);
    lines.extend(order.into_iter().filter(shown).map(|i| line(trade, i)));
    lines.push(
        "mm but for seconds, MB, area, outline and strain (percentage points), silhouettes (shared part), texture (grey levels); * on the front, ! misses a quality limit"
            .into(),
    );
    lines.push(format!("MB: {}", whose_memory(trade)));
    lines
}

/// What the figure of memory is of.
pub(crate) fn whose_memory(trade: &Trade) -> &'static str {
    match trade.apart {
        true => "the most that each run's own process held, the program itself included",
        false => "the most that the one process of all runs held during each",
    }
}

/// Indices by time; those without one last.
pub(crate) fn by_time(trade: &Trade) -> Vec<usize> {
    let time = |i: &usize| trade.points[*i].measured().map_or(f64::INFINITY, |m| m.time(trade.clock));
    let mut order: Vec<usize> = (0..trade.points.len()).collect();
    order.sort_by(|a, b| time(a).total_cmp(&time(b)));
    order
}

/// What the reference is, and how well it is known.
pub fn reference(trade: &Trade) -> Vec<String> {
    let r = &trade.reference;
    let mut lines: Vec<String> = r.levels.iter().enumerate().map(|(k, l)| level(k, l)).collect();
    lines.push(format!("{}; {}", order("mean distance", r.mean), order("distance of 95 %", r.p95)));
    lines.push(format!("refined no further: {}", r.stopped));
    lines.extend(r.spread.as_ref().map(spread));
    lines.extend(r.neighbours.as_ref().map(neighbours));
    let floor = |f: Floor| match f.mm.is_finite() {
        true => format!("errors below {:.2} mm mean nothing: {}", f.mm, f.words()),
        false => format!("errors mean nothing: {}", f.words()),
    };
    lines.extend(r.floor().map(floor));
    lines
}

fn level(k: usize, l: &ReferenceLevel) -> String {
    let moved = match (l.moved_mm, l.displaced_mm) {
        (Some(m), Some(d)) => format!(
            ", moved by {:.2} mm (mean), {:.2} mm (95 %), {:.2} mm (worst); displaced by {:.2} mm (mean)",
            m.mean, m.p95, m.max, d.mean
        ),
        _ => String::new(),
    };
    let setting = setting_words(&l.setting);
    format!("reference level {k}: {setting}: {} triangles, {:.1} s cpu{moved}", l.triangles, l.cpu_s)
}

fn order(name: &str, order: Option<Order>) -> String {
    match order {
        Some(o) => format!(
            "observed order of the {name} {}, {:.2} mm missing",
            o.order.map_or_else(|| "beyond all bounds".into(), order_words),
            o.missing_mm
        ),
        None => format!("no order of the {name}: the last levels do not come nearer"),
    }
}

fn spread(s: &OwnSpread) -> String {
    let worst = s.p95().map_or_else(|| "none ran".into(), |p| format!("95 % within {p:.2} mm in the worst"));
    format!(
        "its own spread: {} starts moved by {} mm at level {}: {worst}{}",
        s.starts_mm.len() + s.failed.len(),
        s.jitter_mm,
        s.level,
        if s.failed.is_empty() { String::new() } else { format!(", {} failed", s.failed.len()) }
    )
}

fn neighbours(n: &NeighbourLevels) -> String {
    let worst = n.p95().map_or_else(|| "none ran".into(), |p| format!("95 % within {p:.2} mm in the worst"));
    let failed = if n.failed.is_empty() { String::new() } else { format!(", {} failed", n.failed.len()) };
    format!("a fiftieth finer and coarser than level {}: {worst}{failed}", n.level)
}

/// An order above the method's own is luck: it is said how much of it counts.
fn order_words(order: f64) -> String {
    match order > FORMAL_ORDER {
        true => format!("{order:.1} (counted as {FORMAL_ORDER})"),
        false => format!("{order:.2}"),
    }
}

fn line(trade: &Trade, i: usize) -> String {
    let p = &trade.points[i];
    let (number, setting) = (i + 1, setting_of(trade, p));
    match &p.outcome {
        SettingOutcome::Measured(m) => format!("{number:>3}{} {}  {setting}", mark(trade, i, m), figures(m)),
        SettingOutcome::Failed { message, .. } => {
            format!("{number:>3}  {setting}: fails: {}", message.lines().next().unwrap_or(""))
        }
        SettingOutcome::OverLimit { seconds } => {
            format!("{number:>3}  {setting}: stopped after {seconds:.0} s")
        }
    }
}

fn figures(m: &Measured) -> String {
    let e = &m.errors;
    let ease = |name: &str| e.ease_mm.get(name).map_or_else(|| "-".into(), |x| format!("{x:.1}"));
    format!(
        "{:>9.2} {:>7.2} {:>9.2} {:>6} | {:>6.2} {:>6.2} {:>6.1} {:>6.2} | {:>6} {:>6} {:>6} | {:>5.2} {:>5.2} {:>5.2} {:>6.2} | {:>6.4} {:>6.4} {:>5}",
        m.time(Clock::Wall),
        m.time_spread(Clock::Wall),
        m.time(Clock::Cpu),
        m.peak_memory_bytes.map_or_else(|| "-".into(), |b| format!("{:.0}", b as f64 / 1e6)),
        e.distance_mm.mean,
        e.distance_mm.p95,
        e.distance_mm.max,
        e.displacement_mm.mean,
        ease("bust"),
        ease("waist"),
        ease("hip"),
        e.seam_gap_mm,
        e.area_pp,
        e.outline_pp,
        e.strain_p99_pp,
        e.silhouette_front,
        e.silhouette_side,
        e.texture_levels.map_or_else(|| "-".into(), |t| format!("{t:.1}")),
    )
}

fn mark(trade: &Trade, i: usize, m: &Measured) -> char {
    match (trade.front.contains(&i), m.sound) {
        (true, _) => '*',
        (_, false) => '!',
        _ => ' ',
    }
}

/// The setting of a point in words.
pub(crate) fn setting_of(trade: &Trade, p: &Point) -> String {
    let own = trade.points.first().is_some_and(|first| first.key == p.key);
    let words = setting_words(&p.setting);
    if own { format!("{words} (as it is)") } else { words }
}

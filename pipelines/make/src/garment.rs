//! The sample garments as exact curves, millimetres.
//!
//! All are drafted for a figure of height 172 cm, bust 88, waist 70 and hip 96 cm. The frame is
//! that of the pattern: x to the right as seen from outside, y up, the origin below the middle of
//! the garment at its lowest point. Front and back share shoulders, sides (and sleeves), so that
//! what is sewn together has the same length; necks and armholes differ as a tailor cuts them.

/// A point or a vector in the plane: millimetres, in `pattern` centimetres.
pub(crate) type PlanePoint = [f64; 2];

/// Distance between neighbouring points of a flattened curve, mm; a chord this long leaves the
/// tightest curve here (radius 40 mm) by 0.01 mm.
const STEP: f64 = 1.8;

/// A named edge from one corner to the next, counter-clockwise.
#[derive(Debug, Clone)]
pub(crate) struct NamedEdge {
    pub(crate) name: String,
    /// Index of its first point in the outline.
    pub(crate) start: usize,
    /// Index of its last point.
    pub(crate) end: usize,
    pub(crate) length: f64,
}

/// A closed outline, counter-clockwise, with its edges and corners named.
#[derive(Debug, Clone)]
pub(crate) struct NamedOutline {
    pub(crate) points: Vec<PlanePoint>,
    pub(crate) edges: Vec<NamedEdge>,
    pub(crate) corners: Vec<(String, PlanePoint)>,
}

/// Which side of the wearer a piece covers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WearerSide {
    Front,
    Back,
}

/// A cubic Bézier curve.
type Cubic = [PlanePoint; 4];

/// One half of a garment: edges from the hem upwards to the neck, each with the name of the corner
/// at its start.
type HalfOutline = Vec<(&'static str, &'static str, Vec<Cubic>)>;

/// A sleeveless vest, 52 cm wide at the hem, 60 cm long.
pub(crate) fn vest(side: WearerSide) -> NamedOutline {
    let (neck, shoulder, armpit, hem) = ([90.0, 600.0], [184.0, 565.8], [245.0, 351.0], [260.0, 9.0]);
    let seam = vec![
        [hem, [250.0, 75.0], [228.0, 130.0], [228.0, 205.0]],
        [[228.0, 205.0], [228.0, 260.0], [241.0, 305.0], armpit],
    ];
    // The front armhole is scooped deeper than the back one.
    let armhole = match side {
        WearerSide::Front => [armpit, [180.0, 347.0], [146.0, 462.0], shoulder],
        WearerSide::Back => [armpit, [196.0, 349.0], [158.0, 474.0], shoulder],
    };
    let half: HalfOutline = vec![
        ("side", "hem", seam),
        ("armhole", "armpit", vec![armhole]),
        ("shoulder", "shoulder", vec![line(shoulder, neck)]),
    ];
    let depth = if side == WearerSide::Front { 122.0 } else { 36.0 };
    close(&half, &[neck_curve(neck, depth)], &[hem_curve(hem)], side)
}

/// A T-shirt whose sleeves belong to its front and back, 76 cm from cuff to cuff, 68 cm long. The
/// armholes are 24 cm deep, for arms that are spread.
pub(crate) fn tshirt(side: WearerSide) -> NamedOutline {
    let (neck, armpit, hem) = ([88.7, 675.6], [253.3, 386.3], [269.2, 7.0]);
    let (cuff_top, cuff_low) = ([380.0, 524.6], [316.7, 333.6]);
    let seam = vec![
        [hem, [263.9, 89.7], [247.0, 147.8], [245.9, 226.9]],
        [[245.9, 226.9], [245.4, 285.0], [250.2, 329.3], armpit],
    ];
    let underarm = [armpit, [268.1, 368.4], [291.3, 351.5], cuff_low];
    // The shoulder falls by 20 degrees and bends into the sleeve, which falls by 35.
    let top = vec![
        [cuff_top, [335.7, 555.6], [276.6, 601.7], [216.4, 628.6]],
        [[216.4, 628.6], [177.3, 646.0], [133.0, 659.5], neck],
    ];
    let half: HalfOutline = vec![
        ("side", "hem", seam),
        ("underarm", "armpit", vec![underarm]),
        ("cuff", "cuff_low", vec![line(cuff_low, cuff_top)]),
        ("shoulder", "cuff_top", top),
    ];
    let depth = if side == WearerSide::Front { 98.0 } else { 28.0 };
    close(&half, &[neck_curve(neck, depth)], &[hem_curve(hem)], side)
}

/// A knitted top whose sleeves reach the wrists, 118 cm from cuff to cuff, 68 cm long.
pub(crate) fn longsleeve() -> NamedOutline {
    let (neck, armpit, hem) = ([88.0, 676.0], [255.0, 345.0], [266.0, 7.0]);
    let (cuff_top, cuff_low) = ([590.0, 180.0], [515.5, 120.9]);
    let top = vec![
        [cuff_top, [468.0, 334.0], [320.0, 536.0], [232.0, 622.0]],
        [[232.0, 622.0], [190.0, 650.0], [136.0, 662.0], neck],
    ];
    let half: HalfOutline = vec![
        ("side", "hem", vec![[hem, [258.0, 110.0], [247.0, 230.0], armpit]]),
        ("underarm", "armpit", vec![[armpit, [300.0, 314.0], [430.0, 196.0], cuff_low]]),
        ("cuff", "cuff_low", vec![line(cuff_low, cuff_top)]),
        ("shoulder", "cuff_top", top),
    ];
    close(&half, &[neck_curve(neck, 92.0)], &[hem_curve(hem)], WearerSide::Front)
}

/// A shirt that is buttoned in front, 108 cm around the chest, 125 cm from cuff to cuff, 72 cm
/// long.
pub(crate) fn shirt() -> NamedOutline {
    let (neck, armpit, hem) = ([88.0, 717.0], [270.0, 366.0], [276.0, 8.0]);
    let (cuff_top, cuff_low) = ([626.0, 191.0], [546.0, 128.0]);
    let top = vec![
        [cuff_top, [496.0, 354.0], [339.0, 568.0], [246.0, 659.0]],
        [[246.0, 659.0], [201.0, 689.0], [144.0, 702.0], neck],
    ];
    let half: HalfOutline = vec![
        ("side", "hem", vec![[hem, [271.0, 117.0], [262.0, 244.0], armpit]]),
        ("underarm", "armpit", vec![[armpit, [318.0, 333.0], [456.0, 208.0], cuff_low]]),
        ("cuff", "cuff_low", vec![line(cuff_low, cuff_top)]),
        ("shoulder", "cuff_top", top),
    ];
    close(&half, &[neck_curve(neck, 84.0)], &[hem_curve(hem)], WearerSide::Front)
}

/// A skirt that flares from the hip, 73 cm around the waist, 102 around the hip, 55 cm long.
pub(crate) fn skirt() -> NamedOutline {
    let (waist, hip, hem) = ([183.0, 552.0], [255.0, 362.0], [312.0, 9.0]);
    let half: HalfOutline = vec![
        ("side", "hem", vec![[hem, [292.0, 130.0], [270.0, 250.0], hip]]),
        ("hip", "hip", vec![[hip, [244.0, 430.0], [214.0, 500.0], waist]]),
    ];
    close(
        &half,
        &[[waist, [120.0, 547.0], [60.0, 544.0], [0.0, 544.0]]],
        &[hem_curve(hem)],
        WearerSide::Front,
    )
}

/// A dress without sleeves, 95 cm around the chest, 76 around the waist, 96 cm long.
pub(crate) fn dress() -> NamedOutline {
    let (neck, shoulder, armpit) = ([92.0, 962.0], [160.0, 938.0], [237.0, 718.0]);
    let (waist, hem) = ([190.0, 540.0], [345.0, 12.0]);
    let half: HalfOutline = vec![
        ("skirt", "hem", vec![[hem, [300.0, 190.0], [236.0, 430.0], waist]]),
        ("side", "waist", vec![[waist, [204.0, 600.0], [226.0, 660.0], armpit]]),
        ("armhole", "armpit", vec![[armpit, [178.0, 722.0], [140.0, 830.0], shoulder]]),
        ("shoulder", "shoulder", vec![line(shoulder, neck)]),
    ];
    close(&half, &[neck_curve(neck, 108.0)], &[hem_curve(hem)], WearerSide::Front)
}

/// Trousers of legs that taper, 76 cm around the waist, 104 around the hip, 101 cm long.
pub(crate) fn trousers() -> NamedOutline {
    let (waist, hip, outer, inner) = ([190.0, 1010.0], [260.0, 800.0], [196.0, 8.0], [48.0, 0.0]);
    let fork = [0.0, 738.0];
    let side =
        vec![[outer, [214.0, 260.0], [254.0, 560.0], hip], [hip, [262.0, 880.0], [212.0, 960.0], waist]];
    let half: HalfOutline = vec![("outseam", "hem", side)];
    let flip = |p: PlanePoint| [-p[0], p[1]];
    let bottom = [line(flip(outer), flip(inner)), [flip(inner), [-40.0, 260.0], [-8.0, 560.0], fork]];
    close(&half, &[[waist, [120.0, 1006.0], [60.0, 1004.0], [0.0, 1004.0]]], &bottom, WearerSide::Front)
}

/// Shorts, 80 cm around the waist, 103 around the hip, 47 cm long.
pub(crate) fn shorts() -> NamedOutline {
    let (waist, hip, outer, inner) = ([200.0, 470.0], [256.0, 280.0], [292.0, 10.0], [26.0, 0.0]);
    let fork = [0.0, 196.0];
    let side =
        vec![[outer, [280.0, 100.0], [263.0, 200.0], hip], [hip, [252.0, 350.0], [226.0, 420.0], waist]];
    let half: HalfOutline = vec![("outseam", "hem", side)];
    let flip = |p: PlanePoint| [-p[0], p[1]];
    let bottom = [line(flip(outer), flip(inner)), [flip(inner), [-20.0, 70.0], [-6.0, 150.0], fork]];
    close(&half, &[[waist, [120.0, 466.0], [60.0, 464.0], [0.0, 464.0]]], &bottom, WearerSide::Front)
}

/// A child's one-piece with short sleeves and short legs, 64 cm around the chest, 42 cm from neck
/// to fork.
pub(crate) fn onepiece() -> NamedOutline {
    let (neck, armpit, outer, inner) = ([62.0, 540.0], [160.0, 378.0], [172.0, 6.0], [32.0, 0.0]);
    let (cuff_top, cuff_low, fork) = ([258.0, 442.0], [212.0, 334.0], [0.0, 92.0]);
    let top = vec![
        [cuff_top, [226.0, 466.0], [190.0, 496.0], [152.0, 512.0]],
        [[152.0, 512.0], [122.0, 522.0], [92.0, 532.0], neck],
    ];
    let half: HalfOutline = vec![
        ("side", "hem", vec![[outer, [178.0, 110.0], [160.0, 250.0], armpit]]),
        ("underarm", "armpit", vec![line(armpit, cuff_low)]),
        ("cuff", "cuff_low", vec![line(cuff_low, cuff_top)]),
        ("shoulder", "cuff_top", top),
    ];
    let flip = |p: PlanePoint| [-p[0], p[1]];
    let bottom = [line(flip(outer), flip(inner)), [flip(inner), [-26.0, 40.0], [-10.0, 78.0], fork]];
    close(&half, &[neck_curve(neck, 62.0)], &bottom, WearerSide::Front)
}

fn line(a: PlanePoint, b: PlanePoint) -> Cubic {
    [a, mix(a, b, 1.0 / 3.0), mix(a, b, 2.0 / 3.0), b]
}

/// The right half of a neckline: it leaves the shoulder at a right angle and is level in the
/// middle.
fn neck_curve(neck: PlanePoint, depth: f64) -> Cubic {
    let low = [0.0, neck[1] - depth];
    [neck, [neck[0] - 0.18 * depth, neck[1] - 0.62 * depth], [neck[0] * 0.55, low[1]], low]
}

/// The left half of the hem, from its corner to its middle.
fn hem_curve(corner: PlanePoint) -> Cubic {
    [[-corner[0], corner[1]], [-0.8 * corner[0], 0.35 * corner[1]], [-0.45 * corner[0], 0.0], [0.0, 0.0]]
}

/// Both halves, the neck and the hem as one loop from the wearer's hem corner at +x.
fn close(half: &HalfOutline, neck: &[Cubic], hem: &[Cubic], side: WearerSide) -> NamedOutline {
    let (plus, minus) = match side {
        WearerSide::Front => ("left", "right"),
        WearerSide::Back => ("right", "left"),
    };
    let mut outline = NamedOutline { points: Vec::new(), edges: Vec::new(), corners: Vec::new() };
    for (name, corner, curves) in half {
        push(&mut outline, &format!("{name}_{plus}"), &format!("{corner}_{plus}"), &flatten(curves));
    }
    let right = flatten(neck);
    push(&mut outline, "neck", &format!("neck_{plus}"), &join(&right, &mirrored(&right)));
    for (i, (name, _, curves)) in half.iter().enumerate().rev() {
        let corner = half.get(i + 1).map_or("neck", |next| next.1);
        push(
            &mut outline,
            &format!("{name}_{minus}"),
            &format!("{corner}_{minus}"),
            &mirrored(&flatten(curves)),
        );
    }
    let bottom = flatten(hem);
    push(&mut outline, "hem", &format!("hem_{minus}"), &join(&bottom, &mirrored(&bottom)));
    let first = outline.edges.len() - 1;
    outline.edges[first].end = 0;
    outline
}

/// Appends an edge without its last point, which is the next edge's first.
fn push(outline: &mut NamedOutline, name: &str, corner: &str, points: &[PlanePoint]) {
    let start = outline.points.len();
    outline.points.extend(&points[..points.len() - 1]);
    let length = points.windows(2).map(|w| distance(w[0], w[1])).sum();
    outline.edges.push(NamedEdge { name: name.to_owned(), start, end: outline.points.len(), length });
    outline.corners.push((corner.to_owned(), points[0]));
}

fn flatten(curves: &[Cubic]) -> Vec<PlanePoint> {
    let mut points = vec![curves[0][0]];
    for c in curves {
        let chords: f64 = c.windows(2).map(|w| distance(w[0], w[1])).sum();
        let n = (chords / STEP).ceil();
        points.extend((1..=n as usize).map(|i| at(c, i as f64 / n)));
    }
    points
}

/// De Casteljau.
fn at(c: &Cubic, t: f64) -> PlanePoint {
    let (a, b, d) = (mix(c[0], c[1], t), mix(c[1], c[2], t), mix(c[2], c[3], t));
    mix(mix(a, b, t), mix(b, d, t), t)
}

fn mirrored(points: &[PlanePoint]) -> Vec<PlanePoint> {
    points.iter().rev().map(|p| [-p[0], p[1]]).collect()
}

fn join(a: &[PlanePoint], b: &[PlanePoint]) -> Vec<PlanePoint> {
    [a, &b[1..]].concat()
}

pub(crate) fn mix(a: PlanePoint, b: PlanePoint, t: f64) -> PlanePoint {
    [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]
}

pub(crate) fn distance(a: PlanePoint, b: PlanePoint) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(o: &NamedOutline, name: &str) -> f64 {
        o.edges.iter().find(|e| e.name == name).map_or(f64::NAN, |e| e.length)
    }

    #[test]
    fn what_is_sewn_together_has_one_length() {
        for (make, names) in [
            (vest as fn(WearerSide) -> NamedOutline, vec!["side", "shoulder"]),
            (tshirt, vec!["side", "underarm", "shoulder", "cuff"]),
        ] {
            let (front, back) = (make(WearerSide::Front), make(WearerSide::Back));
            for name in names.iter().flat_map(|n| [format!("{n}_left"), format!("{n}_right")]) {
                assert!((length(&front, &name) - length(&back, &name)).abs() < 1e-9, "{name}");
            }
        }
    }

    #[test]
    fn outlines_are_closed_symmetric_and_counter_clockwise() {
        let tops = [
            vest(WearerSide::Front),
            vest(WearerSide::Back),
            tshirt(WearerSide::Front),
            tshirt(WearerSide::Back),
        ];
        for o in tops.into_iter().chain([longsleeve(), skirt(), dress(), trousers()]) {
            let n = o.points.len();
            let step = (0..n).map(|i| distance(o.points[i], o.points[(i + 1) % n])).fold(0.0, f64::max);
            let area: f64 = (0..n)
                .map(|i| {
                    let (a, b) = (o.points[i], o.points[(i + 1) % n]);
                    (a[0] * b[1] - b[0] * a[1]) / 2.0
                })
                .sum();
            assert!(step < 2.0 * STEP, "a gap of {step} mm");
            assert!(area > 2e5, "{area}");
            let side = if o.edges[0].name.starts_with("outseam") { "outseam" } else { "side" };
            let [left, right] = ["left", "right"].map(|s| length(&o, &format!("{side}_{s}")));
            assert!((left - right).abs() < 1e-9);
            assert_eq!(o.edges.last().map(|e| e.end), Some(0));
        }
    }
}

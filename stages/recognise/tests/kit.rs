//! A network of one layer: what is light is body, what is red is the left of the neck, and what is
//! seen of the whole is the same for every photo.

use crate::onnx::{Net, Node};
use image::{Rgb, RgbImage};
use toile_recognise::{GRID, Part, PartsNetwork, SIDE, STRIDE, SeenGarment};

/// How steep the answer is, logits for each share of full light.
const STEEP: f32 = 20.0;
/// The logit of what is not seen.
pub(crate) const NOT: f32 = -60.0;

/// A list of `N` logits that are `other` but for some.
pub(crate) fn but<const N: usize>(other: f32, some: &[(usize, f32)]) -> Vec<f32> {
    let mut list = vec![other; N];
    some.iter().for_each(|(at, logit)| list[*at] = *logit);
    list
}

/// The kernels of a convolution over whole cells: for each channel that it gives, a slope a colour.
fn kernels(channels: usize, sloped: (usize, [f32; 3])) -> Vec<f32> {
    let cell = STRIDE * STRIDE;
    let slope = |channel: usize, colour: usize| if channel == sloped.0 { sloped.1[colour] } else { 0.0 };
    let of = |channel| (0..3).flat_map(move |colour| vec![slope(channel, colour) / cell as f32; cell]);
    (0..channels).flat_map(of).collect()
}

/// The network: a cell whose mean level is above one half is body; kind, lies and flags are fixed.
pub(crate) fn tiny() -> Net {
    let (side, grid, step) = (SIDE as u64, GRID as u64, STRIDE as u64);
    let conv = |takes: [&'static str; 2], gives| Node {
        operator: "Conv",
        takes: vec!["photo", takes[0], takes[1]],
        gives,
        steps: step,
    };
    let node = |operator, takes: Vec<&'static str>, gives| Node { operator, takes, gives, steps: 1 };
    let gemm = |slopes, shift, gives| node("Gemm", vec!["flat", slopes, shift], gives);
    let body = (Part::Body as usize, [STEEP / 3.0; 3]);
    let lists = [
        ("presence", but::<20>(-3.0, &[(0, 3.0)])),
        ("kinds", but::<12>(0.0, &[(7, 2.0), (3, 1.0)])),
        ("lies", but::<20>(0.0, &[(1, 5.0), (9, 5.0), (10, 5.0), (13, 5.0)])),
        ("flags", vec![-2.0, 0.0, 2.0]),
    ];
    let mut net = Net {
        takes: vec![("photo", Some(vec![1, 3, side, side]))],
        gives: vec![("parts", Some(vec![1, 11, grid, grid])), ("landmarks", Some(vec![1, 20, grid, grid]))],
        nodes: vec![
            conv(["part_slopes", "part_shift"], "parts"),
            conv(["mark_slopes", "mark_shift"], "landmarks"),
            node("GlobalAveragePool", vec!["photo"], "pooled"),
            node("Flatten", vec!["pooled"], "flat"),
            gemm("presence_slopes", "presence_shift", "presence"),
            gemm("kinds_slopes", "kinds_shift", "kinds"),
            gemm("lies_slopes", "lies_shift", "lies"),
            gemm("flags_slopes", "flags_shift", "flags"),
        ],
        constants: vec![
            ("part_slopes", vec![11, 3, step, step], kernels(11, body)),
            ("part_shift", vec![11], but::<11>(NOT, &[(0, 0.0), (1, -STEEP / 2.0)])),
            ("mark_slopes", vec![20, 3, step, step], kernels(20, (0, [STEEP, -STEEP, -STEEP]))),
            ("mark_shift", vec![20], vec![0.0; 20]),
        ],
    };
    let names = ["presence", "kinds", "lies", "flags"];
    let slopes = ["presence_slopes", "kinds_slopes", "lies_slopes", "flags_slopes"];
    let shifts = ["presence_shift", "kinds_shift", "lies_shift", "flags_shift"];
    for (i, (name, list)) in lists.into_iter().enumerate() {
        let n = list.len() as u64;
        assert_eq!(name, names[i]);
        net.gives.push((name, Some(vec![1, n])));
        net.constants.push((slopes[i], vec![3, n], vec![0.0; 3 * list.len()]));
        net.constants.push((shifts[i], vec![n], list));
    }
    net
}

/// The values of a constant of a network.
pub(crate) fn values<'a>(net: &'a mut Net, name: &str) -> &'a mut Vec<f32> {
    &mut net.constants.iter_mut().find(|constant| constant.0 == name).unwrap().2
}

/// What the tiny network sees in a photo.
pub(crate) fn seen(photo: &RgbImage) -> SeenGarment {
    PartsNetwork::load_other(&tiny().file()).unwrap().see(photo, 1).unwrap()
}

/// A photo of `width` x `height` pixels, light in a box (left, top, right, bottom) and dark
/// outside.
pub(crate) fn boxed(width: u32, height: u32, (left, top, right, bottom): (u32, u32, u32, u32)) -> RgbImage {
    let is_light = |x, y| (left..right).contains(&x) && (top..bottom).contains(&y);
    RgbImage::from_fn(width, height, |x, y| Rgb([if is_light(x, y) { 240 } else { 20 }; 3]))
}

/// Whether all that can be asked of it is sound: probabilities finite and within 0 and 1, sums 1,
/// places on the photo, lists sorted.
pub(crate) fn check(seen: &SeenGarment, (width, height): (u32, u32)) -> Result<(), String> {
    let is_share = |share: f64| (0.0..=1.0).contains(&share);
    let good =
        |what: &str, holds: bool| if holds { Ok(()) } else { Err(format!("{what}: {width} x {height}")) };
    let maps: Vec<Vec<f32>> = Part::ALL.iter().map(|part| seen.map(*part)).collect();
    for cell in 0..GRID * GRID {
        let sum: f32 = maps.iter().map(|map| map[cell]).sum();
        good("cells", (sum - 1.0).abs() < 1e-4)?;
    }
    good("maps", maps.iter().flatten().all(|share| is_share(f64::from(*share))))?;
    let places = [(0.0, 0.0), (-9.0, 1e9), (f64::NAN, f64::INFINITY), (f64::from(width), 0.5)];
    let at = |part: Part| places.iter().all(|(x, y)| is_share(seen.probability(part, *x, *y)));
    good("places", Part::ALL.into_iter().all(at))?;
    let mask = seen.mask(7, 5);
    good("mask", mask.len() == 35 && mask.iter().all(|share| is_share(f64::from(*share))))?;
    good("parts", seen.part_map(3, 4).len() == 12 && seen.part_map(0, 4).is_empty())?;
    for mark in seen.landmarks() {
        let on = |at: f64, side: u32| (-0.5..=f64::from(side) - 0.5).contains(&at);
        good("landmark", on(mark.place.x, width) && on(mark.place.y, height))?;
        good("shares of landmarks", is_share(mark.presence) && is_share(mark.share))?;
    }
    let falling = |shares: &[f64]| {
        shares.is_sorted_by(|a, b| a >= b) && (shares.iter().sum::<f64>() - 1.0).abs() < 1e-9
    };
    good("kinds", falling(&seen.kinds().iter().map(|kind| kind.1).collect::<Vec<_>>()))?;
    let limbs = toile_recognise::Limb::ALL.map(|limb| seen.limb(limb).map(|lie| lie.1));
    good("limbs", limbs.iter().all(|lies| falling(lies)))?;
    good("flags", [seen.hanger(), seen.flat(), seen.whole()].into_iter().all(is_share))
}

//! Shows what the network sees: `see PHOTO OUT.png [NETWORK.onnx]`.
//!
//! Prints kind, limbs, flags and landmarks of a photo, and writes the photo with its parts in
//! colours and its landmarks as crosses, those that are likelier absent left out. With a third
//! argument another network is run in the place of the program's own.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use image::{Rgb, RgbImage};
use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;
use toile_recognise::{Limb, Part, PartsNetwork, SeenGarment, see};

/// The colour of each part, in their order; ground keeps the photo's.
const COLOURS: [[u8; 3]; Part::ALL.len()] = [
    [0, 0, 0],
    [60, 120, 230],
    [240, 130, 30],
    [250, 210, 40],
    [40, 170, 90],
    [150, 220, 80],
    [160, 80, 200],
    [230, 60, 130],
    [120, 70, 40],
    [40, 200, 210],
    [220, 30, 30],
];
/// How much of a part's colour covers the photo.
const COVER: f64 = 0.5;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let done = match args.as_slice() {
        [photo, out] => show(photo, out, None),
        [photo, out, network] => show(photo, out, Some(network)),
        _ => Err("use: see PHOTO OUT.png [NETWORK.onnx]".into()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("error: {e}");
            ExitCode::FAILURE
        }
    }
}

fn show(photo: &str, out: &str, network: Option<&String>) -> Result<(), Box<dyn Error>> {
    let photo = image::open(photo)?.into_rgb8();
    let threads = std::thread::available_parallelism()?.get();
    let other = network.map(std::fs::read).transpose()?;
    let other = other.map(|file| PartsNetwork::load_other(&file)).transpose()?;
    let once = || other.as_ref().map_or_else(|| see(&photo, threads), |network| network.see(&photo, threads));
    once()?;
    let start = Instant::now();
    let seen = once()?;
    let ms = start.elapsed().as_secs_f64() * 1000.0;
    println!("{} x {} pixels, {ms:.1} ms on {threads} threads", photo.width(), photo.height());
    tell(&seen);
    drawn(&photo, &seen).save(out)?;
    Ok(())
}

/// Prints what is seen.
fn tell(seen: &SeenGarment) {
    let shares = |shares: Vec<(&str, f64)>| {
        let likely = shares.into_iter().filter(|(_, share)| *share >= 0.01);
        likely.map(|(name, share)| format!("{name} {share:.2}")).collect::<Vec<_>>().join(", ")
    };
    println!("kind: {}", shares(seen.kinds().iter().map(|(kind, share)| (kind.name(), *share)).collect()));
    for limb in Limb::ALL {
        let lies = seen.limb(limb).map(|(lie, share)| (lie.name(), share));
        println!("{limb}: {}", shares(lies.to_vec()));
    }
    println!("hanger {:.2}, flat {:.2}, whole {:.2}", seen.hanger(), seen.flat(), seen.whole());
    for mark in seen.landmarks() {
        let (x, y) = (mark.place.x, mark.place.y);
        println!("{}: {x:.1} {y:.1}, there {:.2}, heat {:.2}", mark.landmark, mark.presence, mark.share);
    }
}

/// The photo with its parts in colours and its landmarks as crosses.
fn drawn(photo: &RgbImage, seen: &SeenGarment) -> RgbImage {
    let (width, height) = photo.dimensions();
    let mut out = photo.clone();
    let parts = seen.part_map(width as usize, height as usize);
    for (pixel, part) in out.pixels_mut().zip(parts).filter(|(_, part)| *part != Part::Ground) {
        for (level, colour) in pixel.0.iter_mut().zip(COLOURS[part as usize]) {
            *level = (f64::from(*level) * (1.0 - COVER) + f64::from(colour) * COVER) as u8;
        }
    }
    let arm = i64::from(width.max(height)) / 100 + 1;
    for mark in seen.landmarks().iter().filter_map(|mark| seen.landmark(mark.landmark)) {
        let (x, y) = (mark.place.x.round() as i64, mark.place.y.round() as i64);
        let along = (-arm..=arm).flat_map(|k| [(x + k, y + k), (x + k, y - k), (x + k, y + k + 1)]);
        for (x, y) in along {
            let inside = (0..i64::from(width)).contains(&x) && (0..i64::from(height)).contains(&y);
            if inside {
                out.put_pixel(x as u32, y as u32, Rgb([255, 255, 255]));
            }
        }
    }
    out
}

//! Times the readers, denoisers and binarisers on a 12-megapixel photo.
//!
//!     cargo run --release -p toile-stages --example time_images [PHOTO]
//!
//! Without PHOTO a picture is drawn: a dark tee on a noisy light ground. Prints the best of three
//! runs, and the whole of reading, denoising and binarising two photos at once.

#![allow(clippy::print_stdout)]

use image::{ImageFormat, Rgb, RgbImage};
use rayon::prelude::*;
use std::error::Error;
use std::io::Cursor;
use std::sync::Arc;
use std::time::Instant;
use toile_core::prelude::*;
use toile_core::{Inputs, PortValue};
use toile_stages::binarise::{Background, GraphCut, Local, Otsu};
use toile_stages::denoise::{Bilateral, Gaussian, Median, NeighbourhoodMean, Neighbours};
use toile_stages::photo::decode;

fn main() -> Result<(), Box<dyn Error>> {
    let bytes = match std::env::args().nth(1) {
        Some(file) => std::fs::read(file)?,
        None => drawn()?,
    };
    let read = || -> Result<Photo, StageError> {
        let decoded = decode(&bytes, "photo")?;
        Ok(Photo {
            pixels: decoded.pixels.into(),
            alpha: decoded.alpha.map(Shared::new),
            px_per_metre: None,
            garment_width: None,
            mirrored: false,
            joined: 1,
            file: "photo".into(),
        })
    };
    let photo = read()?;
    println!(
        "{} x {} px, {} threads",
        photo.pixels.width(),
        photo.pixels.height(),
        rayon::current_num_threads()
    );
    best("decode", || read().map(drop));
    let input = PortValue::One(Arc::new(photo));
    let stages: Vec<(&str, Box<dyn Stage>)> = vec![
        ("NeighbourhoodMean radius 1", Box::new(NeighbourhoodMean::default())),
        ("NeighbourhoodMean radius 10", Box::new(NeighbourhoodMean { radius: 10, ..Default::default() })),
        (
            "NeighbourhoodMean Four",
            Box::new(NeighbourhoodMean { mask: Neighbours::Four, ..Default::default() }),
        ),
        ("Median radius 1", Box::new(Median::default())),
        ("Median radius 5", Box::new(Median { radius: 5 })),
        ("Gaussian sigma 1", Box::new(Gaussian::default())),
        ("Bilateral radius 3", Box::new(Bilateral::default())),
        ("Otsu", Box::new(Otsu::default())),
        ("Local", Box::new(Local::default())),
        ("Background", Box::new(Background::default())),
        ("GraphCut", Box::new(GraphCut::default())),
    ];
    for (name, stage) in &stages {
        best(name, || run(stage.as_ref(), &input).map(drop));
    }
    let (denoise, binarise) = (NeighbourhoodMean::default(), Otsu::default());
    best("two photos: decode, NeighbourhoodMean, Otsu", || {
        let one = || run(&binarise, &run(&denoise, &PortValue::One(Arc::new(read()?)))?);
        (0..2).into_par_iter().map(|_| one().map(drop)).collect::<Result<Vec<()>, _>>().map(drop)
    });
    Ok(())
}

fn run(stage: &dyn Stage, input: &PortValue) -> Result<PortValue, StageError> {
    let out = stage.run_ports(&Inputs(vec![Some(input.clone())]), &Context::quiet())?;
    out.into_iter().next().ok_or_else(|| StageError::internal("no output"))
}

fn best(name: &str, f: impl Fn() -> Result<(), StageError>) {
    let mut least = f64::INFINITY;
    let mut fault = String::new();
    for _ in 0..3 {
        let start = Instant::now();
        fault = f().err().map_or_else(String::new, |e| format!("  ({e})"));
        least = least.min(start.elapsed().as_secs_f64());
    }
    println!("{name:48}{:>8.1} ms{fault}", least * 1e3);
}

fn drawn() -> Result<Vec<u8>, Box<dyn Error>> {
    let mut state = 1u32;
    let picture = RgbImage::from_fn(3000, 4000, |x, y| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let noise = (state >> 28) as u8;
        let tee = (900..2100).contains(&x) && (800..3300).contains(&y)
            || (500..2500).contains(&x) && (800..1500).contains(&y);
        Rgb(if tee { [40 + noise, 60 + noise, 120 + noise] } else { [200 + noise, 190 + noise, 180 + noise] })
    });
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Jpeg)?;
    Ok(bytes.into_inner())
}

//! Flattens a garment or a piece:
//!
//!     flat METHOD IN.obj OUT.obj [TRUE.obj] [--up z] [--tension WARP,WEFT] [--care] [--darts] [--svg]
//!
//! METHOD: lscm, arap, sd, springs or woven. Corners with `f v/vt` are cut into UV islands. OUT.obj
//! holds the flat places as `vt`, in the order of the input's triangles, and OUT.obj.svg shows them
//! with `--svg`. TRUE.obj holds the garment's true flat pieces, the same triangles in the same
//! order: the table then says how far each piece's area and outline are from the truth.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use nalgebra::{Point2, Point3, Vector3};
use std::fmt::Write;
use std::time::Instant;
use toile_flatten::FlattenError;
use toile_flatten::care::{
    CareOptions, DartOptions, Objective, SeamLengths, mirror_distance, propose_darts, refine,
};
use toile_flatten::distortion::distortion;
use toile_flatten::energy::WovenStiffness;
use toile_flatten::flatteners::{
    ArapOptions, Flattening, Placement, Tension, arap, lscm, springs, symmetric_dirichlet, woven,
};
use toile_flatten::grain::Grain;
use toile_flatten::islands::{SurfacePiece, SurfacePieces, islands_by_uv, split_components, weld_uv};
use toile_flatten::newton::StoppingLimits;
use toile_flatten::surface::PieceSurface;

type Failure = Box<dyn std::error::Error>;

#[derive(Default)]
struct Obj {
    places: Vec<Point3<f64>>,
    uv: Vec<Point2<f64>>,
    triangles: Vec<[u32; 3]>,
    uv_triangles: Vec<[u32; 3]>,
}

fn numbers<const N: usize>(words: std::str::SplitAsciiWhitespace<'_>) -> Result<[f64; N], Failure> {
    let mut x = [0.0; N];
    for (x, word) in x.iter_mut().zip(words) {
        *x = word.parse()?;
    }
    Ok(x)
}

fn read(path: &str) -> Result<Obj, Failure> {
    let text = std::fs::read_to_string(path)?;
    let mut obj = Obj::default();
    for line in text.lines() {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => obj.places.push(Point3::from(numbers::<3>(words)?)),
            Some("vt") => obj.uv.push(Point2::from(numbers::<2>(words)?)),
            Some("f") => {
                let (mut t, mut u) = ([0; 3], [0; 3]);
                for (k, word) in words.take(3).enumerate() {
                    let mut parts = word.split('/');
                    t[k] = parts.next().unwrap_or("").parse::<u32>()?.saturating_sub(1);
                    u[k] = parts.next().unwrap_or("").parse::<u32>().unwrap_or(1).saturating_sub(1);
                }
                obj.triangles.push(t);
                obj.uv_triangles.push(u);
            }
            _ => {}
        }
    }
    Ok(obj)
}

fn pieces(obj: &Obj) -> Result<SurfacePieces, Failure> {
    if obj.uv.is_empty() {
        return Ok(split_components(&obj.places, &obj.triangles)?);
    }
    let weld = weld_uv(&obj.uv, 0.0);
    let uv: Vec<_> = obj.uv_triangles.iter().map(|t| t.map(|u| weld[u as usize])).collect();
    Ok(islands_by_uv(&obj.places, &obj.triangles, &uv)?)
}

fn flatten(method: &str, surface: &PieceSurface, placement: &Placement) -> Result<Flattening, FlattenError> {
    let newton = StoppingLimits::default();
    match method {
        "lscm" => lscm(surface, placement),
        "sd" => symmetric_dirichlet(surface, newton, placement),
        "springs" => springs(surface, newton, placement),
        "woven" => woven(surface, WovenStiffness::COTTON, newton, placement),
        _ => arap(surface, ArapOptions::default(), placement),
    }
}

fn objective(method: &str) -> Objective {
    match method {
        "springs" => Objective::Springs,
        "woven" => Objective::Woven(WovenStiffness::COTTON),
        "sd" => Objective::SymmetricDirichlet,
        _ => Objective::Arap,
    }
}

/// Proposes darts for every piece; prints each.
fn print_darts(method: &str, garment: &SurfacePieces, placement: &Placement) -> Result<(), Failure> {
    for (i, piece) in garment.pieces.iter().enumerate() {
        let begin = Instant::now();
        let darts = propose_darts(&piece.surface, &objective(method), placement, DartOptions::default())?;
        for dart in &darts {
            let place = |v: u32| piece.surface.positions()[v as usize];
            let ends = [dart.path[0], dart.path[dart.path.len() - 1]].map(place);
            println!(
                "dart in piece {i}: from {:.4} to {:.4}, saves {:.3}, strain {:.4} -> {:.4}, mirror {:?}",
                ends[0], ends[1], dart.saves, dart.strain[0], dart.strain[1], dart.mirror,
            );
        }
        println!("piece {i}: {} darts in {:.0} ms", darts.len(), begin.elapsed().as_secs_f64() * 1e3);
    }
    Ok(())
}

/// Makes seams equal, straight edges straight, and left and right mirror images; prints what
/// changed.
fn take_care(
    method: &str,
    garment: &SurfacePieces,
    flats: &mut [Flattening],
    placement: &Placement,
) -> Result<(), Failure> {
    let objective = objective(method);
    let begin = Instant::now();
    let placements = vec![placement.clone(); flats.len()];
    let report = refine(garment, flats, &objective, &placements, CareOptions::default())?;
    let ms = begin.elapsed().as_secs_f64() * 1e3;
    let worst = |of: fn(&SeamLengths) -> [f64; 2]| {
        report.seams.iter().map(|s| SeamLengths::mismatch(of(s))).fold(0.0, f64::max)
    };
    println!(
        "care: {} seams, worst mismatch {:.2e} -> {:.2e}; straight chains {:?}; {ms:.0} ms",
        report.seams.len(),
        worst(|s| s.before),
        worst(|s| s.after),
        report.straight,
    );
    for (pair, before) in &report.mirrors {
        let after = mirror_distance(pair, &flats[pair.a].points, &flats[pair.b].points);
        println!(
            "care: pieces {} and {} are mirror images, apart by {before:.2e} -> {after:.2e}",
            pair.a, pair.b
        );
    }
    for pair in &report.outlines {
        println!(
            "care: outlines {} and {} are mirror images, apart by {:.2e} -> {:.2e}",
            pair.a, pair.b, pair.before, pair.after
        );
    }
    Ok(())
}

/// Area and outline of a true flat piece, from the corners of its triangles.
fn truth(piece: &SurfacePiece, truth: &Obj) -> (f64, f64) {
    let corner =
        |t: usize, k: usize| truth.places[truth.triangles[piece.triangles[t] as usize][k % 3] as usize];
    let (mut area, mut outline) = (0.0, 0.0);
    for t in 0..piece.triangles.len() {
        area += (corner(t, 1) - corner(t, 0)).cross(&(corner(t, 2) - corner(t, 0))).norm() / 2.0;
        for k in 0..3 {
            if piece.surface.opposite()[3 * t + k] == u32::MAX {
                outline += (corner(t, k + 1) - corner(t, k)).norm();
            }
        }
    }
    (area, outline)
}

fn svg(pieces: &[(SurfacePiece, Flattening)]) -> String {
    let (mut body, mut x, mut height) = (String::new(), 0.0, 0.0f64);
    for (piece, flat) in pieces {
        let low = flat.points.iter().fold(Point2::new(f64::MAX, f64::MAX), |m, p| m.inf(p));
        let high = flat.points.iter().fold(Point2::new(f64::MIN, f64::MIN), |m, p| m.sup(p));
        let size = high - low;
        let place = |v: u32| {
            let p = flat.points[v as usize];
            format!("{:.5},{:.5}", p.x - low.x + x, high.y - p.y)
        };
        for t in piece.surface.triangles() {
            let [a, b, c] = t.map(place);
            let _ = write!(body, "<path d='M{a} {b} {c}Z' class='t'/>");
        }
        for vertices in piece.surface.loops() {
            let points: Vec<_> = vertices.iter().map(|&v| place(v)).collect();
            let _ = write!(body, "<path d='M{}Z' class='o'/>", points.join(" "));
        }
        x += size.x * 1.1;
        height = height.max(size.y);
    }
    let style = ".t{fill:#eee;stroke:#aaa}.o{fill:none;stroke:#000}path{vector-effect:non-scaling-stroke}";
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='1600' viewBox='0 0 {x} {height}'><style>{style}</style>{body}</svg>"
    )
}

fn obj_text(obj: &Obj, pieces: &[(SurfacePiece, Flattening)]) -> String {
    let mut text = String::new();
    let mut corners = vec![[0; 3]; obj.triangles.len()];
    let mut first = 1;
    for (piece, flat) in pieces {
        for (&t, mesh) in piece.triangles.iter().zip(piece.surface.triangles()) {
            for v in mesh {
                let k = obj.triangles[t as usize]
                    .iter()
                    .position(|&u| u == piece.vertices[*v as usize])
                    .unwrap_or(0);
                corners[t as usize][k] = *v as usize + first;
            }
        }
        for p in &flat.points {
            let _ = writeln!(text, "vt {} {}", p.x, p.y);
        }
        first += flat.points.len();
    }
    for p in &obj.places {
        let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
    }
    for (t, u) in obj.triangles.iter().zip(&corners) {
        let _ = writeln!(text, "f {}/{} {}/{} {}/{}", t[0] + 1, u[0], t[1] + 1, u[1], t[2] + 1, u[2]);
    }
    text
}

fn main() -> Result<(), Failure> {
    let mut args: Vec<String> = std::env::args().skip(1).collect();
    let up = args.iter().position(|a| a == "--up").map(|k| args.drain(k..args.len().min(k + 2)).nth(1));
    let up = if up.flatten().is_some_and(|axis| axis == "z") { Vector3::z() } else { Vector3::y() };
    let tension =
        args.iter().position(|a| a == "--tension").map(|k| args.drain(k..args.len().min(k + 2)).nth(1));
    let [warp, weft] = match tension.flatten() {
        Some(text) => numbers::<2>(text.replace(',', " ").split_ascii_whitespace())?,
        None => [0.0; 2],
    };
    let tension = Tension { warp, weft };
    let care = args.iter().position(|a| a == "--care").map(|k| args.remove(k)).is_some();
    let with_svg = args.iter().position(|a| a == "--svg").map(|k| args.remove(k)).is_some();
    let darts = args.iter().position(|a| a == "--darts").map(|k| args.remove(k)).is_some();
    let placement = Placement { grain: Grain::Direction(up), tension };
    let [method, input, output, rest @ ..] = &args[..] else {
        return Err("usage: flat METHOD IN.obj OUT.obj [TRUE.obj]".into());
    };
    let obj = read(input)?;
    let true_pieces = rest.first().map(|p| read(p)).transpose()?;
    let garment = pieces(&obj)?;
    let mut flats = Vec::new();
    let mut times = Vec::new();
    for piece in &garment.pieces {
        let begin = Instant::now();
        flats.push(flatten(method, &piece.surface, &placement)?);
        times.push(begin.elapsed());
    }
    if darts {
        print_darts(method, &garment, &placement)?;
    }
    if care {
        take_care(method, &garment, &mut flats, &placement)?;
    }
    println!(
        "piece  tri  start       its  area err  local err outline err corner  warp mean/p99   weft mean/p99   principal p99 flips cross ms  area/true outline/true"
    );
    for (i, (piece, flat)) in garment.pieces.iter().zip(&flats).enumerate() {
        let ms = times[i].as_secs_f64() * 1e3;
        let d = distortion(&piece.surface, &flat.points)?;
        print!(
            "{i:3} {:7} {:11} {:3} {:9.5} {:9.5} {:9.5} {:6.2} {:.5}/{:.5} {:.5}/{:.5} {:.5} {:3} {:3} {ms:6.0}",
            piece.triangles.len(),
            format!("{:?}", flat.start),
            flat.report.iterations,
            d.area_error,
            d.local_area_error,
            d.outline_error,
            d.corner_change,
            d.warp.mean,
            d.warp.p99,
            d.weft.mean,
            d.weft.p99,
            d.principal.p99,
            d.flipped,
            d.crossings,
        );
        if let Some(t) = &true_pieces {
            let (area, outline) = truth(piece, t);
            print!("  {:+.5} {:+.5}", d.area_2d / area - 1.0, d.outline_2d / outline - 1.0);
        }
        println!("{}", if flat.report.converged { "" } else { " not converged" });
    }
    let done: Vec<_> = garment.pieces.into_iter().zip(flats).collect();
    std::fs::write(output, obj_text(&obj, &done))?;
    if with_svg {
        std::fs::write(format!("{output}.svg"), svg(&done))?;
    }
    Ok(())
}

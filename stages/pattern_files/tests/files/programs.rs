//! Files as other programs see them: `ezdxf` audits, `pdftoppm` renders. Skipped where they are
//! missing.

use crate::common::*;
use std::process::Command;
use toile_core::artifact::*;
use toile_pattern_files::DrawingOptions;
use toile_pattern_files::allowance::Allowances;
use toile_pattern_files::dxf::{Standard, to_dxf};
use toile_pattern_files::pdf::{Paper, to_pdf};

/// Pixels an inch.
const DPI: f64 = 300.0;
const MM: f64 = 25.4 / DPI;

fn allowed() -> DrawingOptions {
    DrawingOptions {
        allowances: Allowances { sewn: 0.01, free: 0.02, ..Allowances::default() },
        ..DrawingOptions::default()
    }
}

fn runs(program: &str, arguments: &[&str]) -> bool {
    Command::new(program).args(arguments).output().is_ok_and(|o| o.status.success())
}

#[test]
fn ezdxf_finds_no_fault() {
    let python = std::env::var("TOILE_PYTHON").unwrap_or_else(|_| "python3".into());
    if !runs(&python, &["-c", "import ezdxf"]) {
        eprintln!("skipped: {python} has no ezdxf");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut odd = blouse();
    odd.pieces[0].name = "Ärmel 袖 <&>".into();
    odd.seams.clear();
    for (k, pattern) in [blouse(), odd].iter().enumerate() {
        for (standard, word) in [(Standard::Aama, "aama"), (Standard::Astm, "astm")] {
            let file = folder.path().join(format!("{word}{k}.dxf"));
            std::fs::write(&file, to_dxf(pattern, standard, &allowed()).unwrap().bytes).unwrap();
            let audit = "import ezdxf, sys; a = ezdxf.readfile(sys.argv[1]).audit(); print(len(a.errors), len(a.fixes))";
            let out = Command::new(&python).args(["-c", audit]).arg(&file).output().unwrap();
            assert_eq!(String::from_utf8_lossy(&out.stdout).trim(), "0 0", "{word}");
        }
    }
}

/// A page as grey values, white 0 and black 255.
struct Picture {
    width: usize,
    pixels: Vec<u8>,
}

impl Picture {
    fn of(pdf: &std::path::Path, page: usize) -> Self {
        let n = page.to_string();
        let out = Command::new("pdftoppm")
            .args(["-r", "300", "-gray", "-f", &n, "-l", &n])
            .arg(pdf)
            .output()
            .unwrap();
        let bytes = out.stdout;
        let mut words = bytes.split(|b| b.is_ascii_whitespace());
        assert_eq!(words.next(), Some(&b"P5"[..]));
        let mut number = || std::str::from_utf8(words.next().unwrap()).unwrap().parse::<usize>().unwrap();
        let (width, height) = (number(), number());
        let pixels = bytes[bytes.len() - width * height..].iter().map(|b| 255 - b).collect();
        Picture { width, pixels }
    }

    fn at(&self, x: usize, y: usize) -> f64 {
        f64::from(self.pixels[y * self.width + x])
    }

    /// The middle of the ink between two rows of a column, pixels.
    fn middle(&self, x: usize, rows: std::ops::Range<usize>) -> f64 {
        let (mut sum, mut moment) = (0.0, 0.0);
        for y in rows {
            sum += self.at(x, y);
            moment += self.at(x, y) * y as f64;
        }
        moment / sum
    }
}

#[test]
fn the_square_measures_100_mm_and_pages_join() {
    if !runs("pdftoppm", &["-v"]) {
        eprintln!("skipped: there is no pdftoppm");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.pdf");
    // A slanted strip across four columns of pages.
    let corners = vec![p(0.0, 0.0), p(0.6, 0.1), p(0.6, 0.19), p(0.0, 0.09)];
    let edges = ["a", "b", "c", "d"].map(|n| edge(n, EdgeCurve::Line)).into();
    let strip = Piece { name: "strip".into(), outer: PatternLoop { corners, edges }, ..Piece::default() };
    let pattern = Pattern { name: "t".into(), pieces: vec![strip], seams: vec![] };
    std::fs::write(&file, to_pdf(&pattern, Paper::A4, &DrawingOptions::default()).unwrap().bytes).unwrap();
    let first = Picture::of(&file, 1);
    // The square begins 15 mm from the left, 41 mm from above.
    let across: Vec<usize> = (0..first.width)
        .filter(|x| *x as f64 * MM < 120.0 && first.at(*x, (60.0 / MM) as usize) > 127.0)
        .collect();
    let high = first.pixels.len() / first.width;
    let down: Vec<usize> = (0..high)
        .filter(|y| (38.0..145.0).contains(&(*y as f64 * MM)) && first.at((25.0 / MM) as usize, *y) > 127.0)
        .collect();
    for line in [across, down] {
        let side = (line[line.len() - 1] - line[0]) as f64 * MM;
        assert!((side - 100.0).abs() < 0.1, "{side}");
    }
    // Cover, order, then the pages of the strip.
    let pages: Vec<Picture> = (3..6).map(|k| Picture::of(&file, k)).collect();
    for pair in pages.windows(2) {
        // The overlap is the last centimetre before the margin of one page, the first behind that
        // of the next.
        for mm in [2.0, 4.0, 6.0, 8.0] {
            let (left, right) = (((190.0 + mm) / MM).round() as usize, ((10.0 + mm) / MM).round() as usize);
            // Below the marks of the joint, above the margin.
            let rows = |from: f64, to: f64| (from / MM) as usize..(to / MM) as usize;
            let of = |page: &Picture, x: usize| {
                let ink = rows(22.0, 140.0).filter(|y| page.at(x, *y) > 200.0).collect::<Vec<_>>();
                let top = ink[0];
                page.middle(x, top - 6..top + 10)
            };
            let slope = 0.1 / 0.6 * ((left as f64 - (190.0 + mm) / MM) - (right as f64 - (10.0 + mm) / MM));
            let off = (of(&pair[0], left) - of(&pair[1], right) + slope) * MM;
            assert!(off.abs() < 0.2, "{mm}: {off} mm");
        }
    }
}

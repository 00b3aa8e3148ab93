//! What bad input gets: a clear error with its place and a hint, exit code 3, and no result
//! written.

use image::{Rgb, RgbImage};
use std::path::{Path, PathBuf};
use toile_tests::{Answer, pipeline, root, toile, wrote_no_result};

const GROUND: Rgb<u8> = Rgb([220, 210, 190]);
const CLOTH: Rgb<u8> = Rgb([40, 60, 120]);
const SIZE: (u32, u32) = (700, 800);

/// A picture whose pixels are cloth where `is_cloth` says so.
fn picture(dir: &Path, name: &str, is_cloth: impl Fn(u32, u32) -> bool) -> PathBuf {
    let path = dir.join(name);
    let pixels = RgbImage::from_fn(SIZE.0, SIZE.1, |x, y| if is_cloth(x, y) { CLOTH } else { GROUND });
    pixels.save(&path).unwrap();
    path
}

/// Runs the vest with something set, and proves that no result was written.
fn refused(set: &str) -> Answer {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let answer = toile(&["run", &pipeline("vest.ron"), "--out", &out.display().to_string(), "--set", set]);
    assert_eq!(answer.code, 3, "{}{}", answer.out, answer.err);
    assert!(wrote_no_result(&out), "something was written");
    answer
}

/// The error's text without its drawing of the file, in one line.
fn words(answer: &Answer) -> String {
    let (mut text, mut in_drawing) = (String::new(), false);
    for line in answer.err.lines().map(str::trim) {
        in_drawing |= line.starts_with("╭─[");
        if !in_drawing {
            text += &format!("{} ", line.trim_start_matches('│'));
        }
        in_drawing &= !line.starts_with("╰────");
    }
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn assert_says(answer: &Answer, text: &str) {
    let words = words(answer);
    assert!(words.contains(text), "`{text}` is not in\n{words}");
}

fn with_front(photo: &Path) -> String {
    format!("photos.front.file={:?}", photo.display().to_string())
}

#[test]
fn a_missing_photo() {
    assert_says(
        &refused("photos.front.file=\"nowhere.jpg\""),
        "Photos: cannot read \"nowhere.jpg\": no such file",
    );
}

#[test]
fn a_truncated_photo() {
    let dir = tempfile::tempdir().unwrap();
    let whole = std::fs::read(root().join("pipelines/samples/vest/front.jpg")).unwrap();
    let path = dir.path().join("cut.jpg");
    std::fs::write(&path, &whole[..5000]).unwrap();
    assert_says(
        &refused(&with_front(&path)),
        "ends before its picture does help: copy it again: it was cut short",
    );
}

#[test]
fn a_text_in_place_of_a_photo() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("photo.jpg");
    std::fs::write(&path, "hello").unwrap();
    assert_says(&refused(&with_front(&path)), "is not a JPEG, PNG, WebP or TIFF picture");
}

/// A PNG header that claims a size and holds no pixels.
fn empty_png(path: &Path, width: u32, height: u32) {
    let mut bytes = vec![0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n'];
    let header = [&width.to_be_bytes()[..], &height.to_be_bytes(), &[8, 2, 0, 0, 0]].concat();
    chunk(&mut bytes, b"IHDR", &header);
    chunk(&mut bytes, b"IDAT", &[0x78, 0x9c, 3, 0, 0, 0, 0, 1]);
    chunk(&mut bytes, b"IEND", &[]);
    std::fs::write(path, bytes).unwrap();
}

fn chunk(bytes: &mut Vec<u8>, kind: &[u8; 4], data: &[u8]) {
    bytes.extend((data.len() as u32).to_be_bytes());
    let body = [&kind[..], data].concat();
    bytes.extend(&body);
    bytes.extend(crc32(&body).to_be_bytes());
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, b| {
        (0..8).fold(crc ^ u32::from(*b), |c, _| (c >> 1) ^ (0xedb8_8320 & (c & 1).wrapping_neg()))
    })
}

#[test]
fn absurd_sizes() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("photo.png");
    empty_png(&path, 0, 0);
    assert_says(&refused(&with_front(&path)), "has no pixels (0 x 0)");
    empty_png(&path, 100_000, 100);
    assert_says(&refused(&with_front(&path)), "is too large: 100000 x 100 px");
    empty_png(&path, 20_000, 20_000);
    assert_says(
        &refused(&with_front(&path)),
        "is too large: 20000 x 20000 px help: at most 30000 px a side, 200 megapixels",
    );
}

#[test]
fn a_blank_photo() {
    let dir = tempfile::tempdir().unwrap();
    let path = picture(dir.path(), "blank.png", |_, _| false);
    assert_says(&refused(&with_front(&path)), "Otsu (front): no garment found in");
}

#[test]
fn two_garments() {
    let dir = tempfile::tempdir().unwrap();
    let two = |x: u32, y: u32| (200..600).contains(&y) && ((60..300).contains(&x) || (400..640).contains(&x));
    let path = picture(dir.path(), "two.png", two);
    // One of them is taken, with a warning, and is no vest.
    let answer = refused(&with_front(&path));
    assert_says(&answer, "a second thing lies in");
    assert_says(&answer, "does not look like a vest");
}

#[test]
fn a_garment_is_cut_along_its_outline_in_any_pipeline_of_photos() {
    for style in ["Vest", "TShirt", "Auto"] {
        let set = format!("style=Outline(style: {style})");
        let answer = toile(&["validate", &pipeline("photo.ron"), "--set", &set]);
        assert_eq!(answer.code, 0, "{style}: {}", answer.err);
    }
    let answer = toile(&["validate", &pipeline("photo.ron"), "--set", "style=Vest()"]);
    assert_eq!(answer.code, 3);
    assert_says(&answer, "the stage `Vest` is now `Outline(style: Vest)`");
}

#[test]
fn a_garment_cut_by_the_frame() {
    let dir = tempfile::tempdir().unwrap();
    let path = picture(dir.path(), "cut.png", |x, y| x < 500 && (200..600).contains(&y));
    assert_says(&refused(&with_front(&path)), "is cut by the frame");
}

#[test]
fn what_ran_until_a_fault_lies_in_a_folder_of_its_own_until_a_run_is_good() {
    let dir = tempfile::tempdir().unwrap();
    let path = picture(dir.path(), "cut.png", |x, y| x < 500 && (200..600).contains(&y));
    let (out, set) = (dir.path().join("out"), with_front(&path));
    let out_text = out.display().to_string();
    let answer = toile(&["run", &pipeline("vest.ron"), "--out", &out_text, "--set", &set]);
    let page = out.join("failed/report.html");
    assert!(
        answer.err.ends_with(&format!("what the run made until then: {}\n", page.display())),
        "{}",
        answer.err
    );
    let reason = std::fs::read_to_string(out.join("failed/reason.txt")).unwrap();
    assert!(reason.starts_with("Otsu (front): the garment in"), "{reason}");
    assert!(reason.contains("\nhelp: leave a margin of ground on all sides"), "{reason}");
    let page = std::fs::read_to_string(page).unwrap();
    let (top, rest) = page.split_once("<h2>Time</h2>").unwrap();
    assert!(top.contains("The run ended in Otsu: ") && top.contains("is cut by the frame"));
    assert!(rest.contains("data:image"), "the stages' pictures");
    // What was taken for the garment: its own colour inside, the line at its edge, dark ground.
    let marked = image::open(out.join("failed/stages/Otsu/photo.png")).unwrap().into_rgb8();
    assert_eq!(marked.get_pixel(250, 400), &CLOTH);
    assert_eq!(marked.get_pixel(500, 400).0, [255, 0, 120]);
    assert_eq!(marked.get_pixel(600, 400).0, GROUND.0.map(|c| (0.4 * f64::from(c)) as u8));

    let good = toile(&["run", &pipeline("vest.ron"), "--out", &out_text, "--until", "Otsu"]);
    assert_eq!(good.code, 0, "{}", good.err);
    assert!(!out.join("failed").exists());
}

#[test]
fn trousers_in_a_vest_pipeline() {
    let dir = tempfile::tempdir().unwrap();
    let legs = |x: u32, y: u32| {
        let spread = y / 10;
        (100..700).contains(&y)
            && (220 - spread..480 + spread).contains(&x)
            && !(y > 300 && (350 - (y - 300) / 8..350 + (y - 300) / 8).contains(&x))
    };
    let path = picture(dir.path(), "trousers.png", legs);
    assert_says(&refused(&with_front(&path)), "Outline: \"front\" does not look like a vest");
}

#[test]
fn a_style_that_does_not_fit() {
    assert_says(&refused("style.style=TShirt"), "does not look like a T-shirt");
}

#[test]
fn lengths_and_numbers() {
    for (set, text) in [
        ("stages.GridMesher.edge=12", "`edge`: the length 12 has no unit; write \"12 mm\" or \"12 cm\""),
        ("stages.GridMesher.edge=\"-3 mm\"", "`edge` is -3 mm, below its least value 0.1 mm"),
        (
            "stages.GridMesher.edge=\"nan mm\"",
            "\"nan mm\" is not a length; write a number and a unit, like \"12 mm\"",
        ),
        ("stages.PlaneSmoother.lambda=NaN", "`lambda` is NaN, which is not a finite number"),
        ("photos.front.width=\"0 cm\"", "the garment's width is 0 m, which is not positive"),
        (
            "stages.GridMesher.edg=\"3 mm\"",
            "`GridMesher` has no parameter `edg` help: did you mean `stages.GridMesher.edge`?",
        ),
        (
            "fabric=Preset(\"coton poplin\")",
            "there is no fabric preset \"coton poplin\" help: did you mean \"cotton poplin\"?",
        ),
    ] {
        assert_says(&refused(set), text);
    }
}

#[test]
fn seams_that_cannot_be_sewn() {
    for (set, text) in [
        ("seams=[Match(\"front.side_left\", \"back.hem\")]", "front.side_left"),
        ("seams=[Match(\"front.side_lft\", \"back.side_left\")]", "side_left"),
        ("seams=[Reversed(\"front.side_left\", \"back.side_left\")]", "front.side_left"),
        ("seams=[Match(\"frnt.side_left\", \"back.side_left\")]", "front"),
    ] {
        let answer = refused(set);
        assert_says(&answer, "Seams: ");
        assert_says(&answer, text);
    }
}

#[test]
fn a_body_that_is_not_closed() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("body.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n").unwrap();
    let answer = refused(&format!("body=BodyObj({:?})", path.display().to_string()));
    assert_says(&answer, "not closed");
}

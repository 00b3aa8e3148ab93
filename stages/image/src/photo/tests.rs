#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use image::{DynamicImage, GrayImage, ImageFormat, Luma, Rgb, RgbImage, Rgba, RgbaImage};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::Arc;
use toile_core::Cancel;
use toile_core::param::ron_options;
use toile_core::prelude::*;

fn encode(image: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// Red on the left, blue on the right.
fn red_blue(w: u32, h: u32) -> RgbImage {
    RgbImage::from_fn(w, h, |x, _| Rgb(if x < w / 2 { [255, 0, 0] } else { [0, 0, 255] }))
}

/// A JPEG with the EXIF orientation `value`.
fn with_orientation(jpeg: &[u8], value: u8) -> Vec<u8> {
    let mut exif = b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
    exif.extend([value, 0, 0, 0, 0, 0, 0]);
    let length = (exif.len() + 2) as u16;
    let mut bytes = vec![0xFF, 0xD8, 0xFF, 0xE1];
    bytes.extend(length.to_be_bytes());
    bytes.extend(exif);
    bytes.extend(&jpeg[2..]);
    bytes
}

/// A folder of its own for one test, with these files.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, files: &[(&str, Vec<u8>)]) -> Self {
        let path = std::env::temp_dir().join(format!("toile-photo-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        files.iter().for_each(|(file, bytes)| std::fs::write(path.join(file), bytes).unwrap());
        Folder(path)
    }

    fn read(&self, photos: &str) -> Result<Set<Photo>, StageError> {
        let cx = Context::new("Photos", &self.0, Cancel::new(), Arc::new(()));
        Photos::new(entries(photos)).run(&cx)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn entries(text: &str) -> BTreeMap<String, PhotoEntry> {
    ron_options().from_str(text).unwrap()
}

fn fault(text: &str) -> (String, usize, usize) {
    let error = ron_options().from_str::<BTreeMap<String, PhotoEntry>>(text).unwrap_err();
    (error.code.to_string(), error.span.start.line, error.span.start.col)
}

#[test]
fn a_front_with_its_mirror_image() {
    let folder = Folder::new("mirror", &[("a.png", encode(red_blue(6, 4), ImageFormat::Png))]);
    let set =
        folder.read(r#"{"front": (file: "a.png", width: "52 cm"), "back": MirrorOf("front")}"#).unwrap();
    let (front, back) = (set.get("front").unwrap(), set.get("back").unwrap());
    assert_eq!((front.mirrored, back.mirrored), (false, true));
    assert_eq!((front.garment_width, back.garment_width), (Some(0.52), Some(0.52)));
    assert!(front.pixels.is_same(&back.pixels), "a mirror costs no memory");
    assert_eq!(front.file, "a.png");
}

#[test]
fn a_mirror_of_a_mirror_is_the_photo_itself() {
    let folder = Folder::new("twice", &[("a.png", encode(red_blue(6, 4), ImageFormat::Png))]);
    let text =
        r#"{"a": (file: "a.png", px_per_metre: 900, mirror: true), "b": MirrorOf("a"), "c": MirrorOf("b")}"#;
    let set = folder.read(text).unwrap();
    let mirrored: Vec<bool> = set.iter().map(|(_, p)| p.mirrored).collect();
    assert_eq!(mirrored, [true, false, true]);
    assert_eq!(set.get("c").unwrap().px_per_metre, Some(900.0));
}

#[test]
fn entries_are_written_as_they_are_read() {
    let text = r#"{"back":MirrorOf("front"),"front":(file:"a.jpg",width:"52 cm")}"#;
    assert_eq!(ron_options().to_string(&entries(text)).unwrap(), text);
}

#[test]
fn a_fault_in_an_entry_keeps_its_place() {
    let cases = [
        ("{\"a\": (file: \"x\", width: 52)}", "the length 52 has no unit; write \"52 mm\" or \"52 cm\"", 1),
        (
            "{\"a\": (file: \"x\",\n  width: 52)}",
            "the length 52 has no unit; write \"52 mm\" or \"52 cm\"",
            2,
        ),
    ];
    for (text, message, line) in cases {
        let (found, at, _) = fault(text);
        assert_eq!((found.as_str(), at), (message, line), "{text}");
    }
    assert!(fault("{\"a\": (file: \"x\", height: \"2 cm\")}").0.contains("`height`"));
    assert!(fault("{\"a\": (width: \"2 cm\")}").0.contains("`file`"));
    assert_eq!(fault("{\"a\": (file: \"x\"),\n \"b\": Mirror(\"a\")}").1, 2);
}

#[test]
fn wrong_sets_are_refused() {
    let folder = Folder::new("wrong", &[("a.png", encode(red_blue(2, 2), ImageFormat::Png))]);
    let text = |photos: &str| folder.read(photos).unwrap_err();
    assert_eq!(text("{}").to_string(), "there are no photos");
    let error = text(r#"{"back": MirrorOf("fornt"), "front": (file: "a.png")}"#);
    assert_eq!(error.to_string(), "photo \"back\" is to mirror \"fornt\", which there is not");
    assert_eq!(error.hint.unwrap(), "did you mean \"front\"? the photos are \"back\", \"front\"");
    let error = text(r#"{"../front": (file: "a.png")}"#);
    assert_eq!(error.to_string(), "a photo is named \"../front\", as no file can be");
    assert_eq!(error.hint.unwrap(), "name it after the garment's side: \"front\", \"back\"");
    assert_eq!(text(r#"{"": (file: "a.png")}"#).to_string(), "a photo is named \"\", as no file can be");
    let error = text(r#"{"back": MirrorOf("front"), "front": MirrorOf("back")}"#);
    assert_eq!(error.to_string(), "photo \"back\" mirrors itself");
    assert_eq!(error.hint.unwrap(), "one of the photos must be a file");
    let error = text(r#"{"front": (file: "a.png", width: "5 cm", px_per_metre: 900)}"#);
    assert_eq!(
        error.to_string(),
        "photo \"front\": both width and px_per_metre are given; one of them fixes the scale"
    );
    let error = text(r#"{"front": (file: "b.png")}"#);
    assert_eq!(error.code, ErrorCode::PatternLoading);
    assert_eq!(error.to_string(), "cannot read \"b.png\": no such file");
}

#[test]
fn a_wrong_width_or_scale_is_told_at_its_field_and_hides_no_other_fault() {
    let folder = Folder::new("widths", &[("a.png", encode(red_blue(2, 2), ImageFormat::Png))]);
    for (given, told, field) in [
        ("width: \"-3 cm\"", "the garment's width is -30 mm, which is not positive", "width"),
        ("width: \"0 m\"", "the garment's width is 0 m, which is not positive", "width"),
        ("width: \"52 m\"", "the garment's width is 52 m, outside 5 mm to 10 m", "width"),
        ("px_per_metre: NaN", "px_per_metre is NaN, outside 100 to 100000 pixels per metre", "px_per_metre"),
    ] {
        let error = folder.read(&format!("{{\"a\": (file: \"a.png\", {given})}}")).unwrap_err();
        assert_eq!(error.to_string(), format!("photo \"a\": {told}"));
        assert_eq!((error.param, error.path), (Some("photos"), vec!["a".to_owned(), field.to_owned()]));
    }
}

#[test]
fn a_width_set_from_code_is_checked_too() {
    let file = PhotoFile::new("a.png", Length::m(f64::NAN));
    let photos = BTreeMap::from([("front".to_owned(), PhotoEntry::File(file))]);
    let error = Photos::new(photos).run(&Context::quiet()).unwrap_err();
    assert_eq!(error.code, ErrorCode::InvalidParameter);
    assert_eq!(error.to_string(), "photo \"front\": the garment's width is not a finite number");
}

#[test]
fn a_photo_is_turned_upright() {
    let jpeg = encode(red_blue(64, 32), ImageFormat::Jpeg);
    // Turned by a quarter, clockwise: what was left is on top.
    let turned = decode(&with_orientation(&jpeg, 6), "a.jpg").unwrap().pixels;
    assert_eq!(turned.dimensions(), (32, 64));
    assert!(turned.get_pixel(16, 4).0[0] > 200 && turned.get_pixel(16, 60).0[2] > 200);
    // Upside down.
    let turned = decode(&with_orientation(&jpeg, 3), "a.jpg").unwrap().pixels;
    assert!(turned.get_pixel(4, 16).0[2] > 200);
    // A value that does not exist.
    assert_eq!(decode(&with_orientation(&jpeg, 77), "a.jpg").unwrap().pixels.dimensions(), (64, 32));
}

#[test]
fn deep_and_grey_pictures_become_eight_bit_colour() {
    let deep = image::ImageBuffer::from_pixel(3, 2, Rgb([65535u16, 32896, 0]));
    let out = decode(&encode(deep, ImageFormat::Png), "a.png").unwrap();
    assert_eq!(out.pixels.get_pixel(0, 0).0, [255, 128, 0]);
    let grey = GrayImage::from_pixel(3, 2, Luma([77]));
    assert_eq!(decode(&encode(grey, ImageFormat::Png), "a.png").unwrap().pixels.get_pixel(2, 1).0, [77; 3]);
}

#[test]
fn alpha_is_kept_where_it_says_something() {
    let opaque = RgbaImage::from_pixel(3, 3, Rgba([9, 8, 7, 255]));
    assert_eq!(decode(&encode(opaque, ImageFormat::Png), "a.png").unwrap().alpha, None);
    // A dark garment is laid on white, a light one on black.
    for (tone, ground) in [(40, 255), (220, 0)] {
        let cut = RgbaImage::from_fn(4, 4, |x, _| Rgba([tone, tone, tone, if x < 2 { 255 } else { 0 }]));
        let out = decode(&encode(cut, ImageFormat::Png), "a.png").unwrap();
        assert_eq!(out.alpha.unwrap().get_pixel(3, 0).0, [0]);
        assert_eq!((out.pixels.get_pixel(0, 0).0, out.pixels.get_pixel(3, 0).0), ([tone; 3], [ground; 3]));
    }
}

/// The header of a PNG of that size, without its pixels.
fn png_header(w: u32, h: u32) -> Vec<u8> {
    let mut bytes = encode(red_blue(2, 2), ImageFormat::Png);
    bytes[16..20].copy_from_slice(&w.to_be_bytes());
    bytes[20..24].copy_from_slice(&h.to_be_bytes());
    bytes
}

#[test]
fn what_is_no_photo_gets_a_clear_error() {
    let jpeg = encode(red_blue(200, 100), ImageFormat::Jpeg);
    let png = encode(red_blue(200, 100), ImageFormat::Png);
    let cases: [(&[u8], ErrorCode, &str); 9] = [
        (b"", ErrorCode::PatternLoading, "photo \"a.jpg\" is empty"),
        (
            b"a recipe for soup",
            ErrorCode::PatternLoading,
            "photo \"a.jpg\" is not a JPEG, PNG, WebP or TIFF picture",
        ),
        (&jpeg[..jpeg.len() / 2], ErrorCode::PatternLoading, "photo \"a.jpg\" ends before its picture does"),
        (&jpeg[..20], ErrorCode::PatternLoading, "photo \"a.jpg\" ends before its picture does"),
        (&png[..png.len() - 20], ErrorCode::PatternLoading, "photo \"a.jpg\" ends before its picture does"),
        (&png_header(0, 0), ErrorCode::InvalidInput, "photo \"a.jpg\" has no pixels (0 x 0)"),
        (&png_header(100_000, 4), ErrorCode::InvalidInput, "photo \"a.jpg\" is too large: 100000 x 4 px"),
        (
            &png_header(20_000, 20_000),
            ErrorCode::InvalidInput,
            "photo \"a.jpg\" is too large: 20000 x 20000 px",
        ),
        (
            &png_header(u32::MAX, u32::MAX),
            ErrorCode::InvalidInput,
            "photo \"a.jpg\" is too large: 4294967295 x 4294967295 px",
        ),
    ];
    for (bytes, code, message) in cases {
        let error = decode(bytes, "a.jpg").unwrap_err();
        assert_eq!((error.code, error.to_string().as_str()), (code, message));
    }
    let hint = decode(&png_header(100_000, 4), "a.jpg").unwrap_err().hint.unwrap();
    assert_eq!(hint, "at most 30000 px a side, 200 megapixels and 1024 MiB decoded; scale it down first");
}

#[test]
fn kinds_that_are_not_read_are_named_with_what_to_do() {
    let heic = b"\0\0\0\x18ftypheic\0\0\0\0mif1heic";
    let error = decode(heic, "a.jpg").unwrap_err();
    assert_eq!(error.message, "photo \"a.jpg\" is a HEIC picture, which is not read");
    let hint = "photos are read from JPEG, PNG, WebP and TIFF files; export it as JPEG";
    assert_eq!((error.code, error.hint.as_deref()), (ErrorCode::PatternLoading, Some(hint)));
    let avif = decode(b"\0\0\0\x1Cftypavif\0\0\0\0mif1avif", "a").unwrap_err();
    assert_eq!(avif.message, "photo \"a\" is an AVIF picture, which is not read");
    // The thumbnail at the head of a raw file is not the photo.
    let raw = tiff(&[(254, 1)]);
    assert_eq!(
        decode(&raw, "a").unwrap_err().message,
        "photo \"a\" is a camera's raw picture, which is not read"
    );
}

/// A TIFF of 3 x 2 pixels, red at its top left, black else, with these tags besides.
fn tiff(more: &[(u16, u16)]) -> Vec<u8> {
    let mut tags: Vec<(u16, u16, u32)> = vec![
        (256, 3, 3),
        (257, 3, 2),
        (258, 3, 8),
        (259, 3, 1),
        (262, 3, 2),
        (273, 4, 8),
        (277, 3, 3),
        (278, 3, 2),
        (279, 4, 18),
    ];
    tags.extend(more.iter().map(|(tag, value)| (*tag, 3, u32::from(*value))));
    tags.sort_unstable();
    let mut bytes = b"II*\0\x1A\0\0\0".to_vec();
    bytes.extend([255, 0, 0]);
    bytes.extend([0; 15]);
    bytes.extend((tags.len() as u16).to_le_bytes());
    for (tag, kind, value) in tags {
        bytes.extend([tag.to_le_bytes(), kind.to_le_bytes()].concat());
        bytes.extend([1_u32.to_le_bytes(), value.to_le_bytes()].concat());
    }
    bytes.extend([0; 4]);
    bytes
}

#[test]
fn a_tiff_is_read_and_turned_upright() {
    let upright = decode(&tiff(&[]), "a.tif").unwrap().pixels;
    assert_eq!((upright.dimensions(), upright.get_pixel(0, 0).0), ((3, 2), [255, 0, 0]));
    // 6: turned by 90 degrees clockwise.
    let turned = decode(&tiff(&[(274, 6)]), "a.tif").unwrap().pixels;
    assert_eq!((turned.dimensions(), turned.get_pixel(1, 0).0), ((2, 3), [255, 0, 0]));
    assert_eq!(super::decode::upright_size(&tiff(&[(274, 6)])), Some((2, 3)));
    let encoded = encode(red_blue(40, 30), ImageFormat::Tiff);
    assert_eq!(decode(&encoded, "a.tif").unwrap().pixels, red_blue(40, 30));
    for length in [9, 20, 30, 100] {
        let error = decode(&tiff(&[])[..length.min(tiff(&[]).len() - 1)], "a.tif").unwrap_err();
        assert_eq!(error.message, "photo \"a.tif\" ends before its picture does");
    }
}

/// A WebP with the EXIF orientation `value`.
fn webp_turned(webp: &[u8], (w, h): (u32, u32), value: u8) -> Vec<u8> {
    let chunk = |kind: &[u8; 4], data: &[u8]| {
        let mut bytes = [&kind[..], &(data.len() as u32).to_le_bytes(), data].concat();
        bytes.resize(bytes.len().next_multiple_of(2), 0);
        bytes
    };
    let mut head = vec![8, 0, 0, 0];
    head.extend(&(w - 1).to_le_bytes()[..3]);
    head.extend(&(h - 1).to_le_bytes()[..3]);
    let mut exif = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
    exif.extend([value, 0, 0, 0, 0, 0, 0]);
    let body = [b"WEBP".to_vec(), chunk(b"VP8X", &head), webp[12..].to_vec(), chunk(b"EXIF", &exif)].concat();
    chunk(b"RIFF", &body)
}

#[test]
fn a_webp_is_read_and_turned_upright() {
    let plain = encode(red_blue(40, 30), ImageFormat::WebP);
    assert_eq!(decode(&plain, "a.webp").unwrap().pixels, red_blue(40, 30));
    let turned = webp_turned(&plain, (40, 30), 6);
    let pixels = decode(&turned, "a.webp").unwrap().pixels;
    assert_eq!(pixels.dimensions(), (30, 40));
    // What was left is on top.
    assert_eq!((pixels.get_pixel(15, 2).0, pixels.get_pixel(15, 38).0), ([255, 0, 0], [0, 0, 255]));
    for length in [13, 25, plain.len() / 2, plain.len() - 2] {
        let error = decode(&plain[..length], "a.webp").unwrap_err();
        assert_eq!(error.message, "photo \"a.webp\" ends before its picture does", "{length}");
    }
    let opaque_half = RgbaImage::from_fn(8, 4, |x, _| Rgba([9, 9, 9, if x < 4 { 255 } else { 0 }]));
    let alpha = decode(&encode(opaque_half, ImageFormat::WebP), "a.webp").unwrap().alpha.unwrap();
    assert_eq!((alpha.get_pixel(0, 0).0, alpha.get_pixel(7, 3).0), ([255], [0]));
}

#[test]
fn a_profile_that_is_packed_in_a_png_is_not_unpacked() {
    use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
    let picture = red_blue(20, 10);
    let mut bytes = Vec::new();
    let mut encoder = PngEncoder::new(&mut bytes);
    encoder.set_icc_profile(vec![0; 1 << 20]).unwrap();
    encoder.write_image(&picture, 20, 10, ExtendedColorType::Rgb8).unwrap();
    let has_profile = |bytes: &[u8]| bytes.windows(4).any(|w| w == b"iCCP");
    assert!(has_profile(&bytes));
    assert!(!has_profile(&super::header::without_extras(super::form::PictureFormat::Png, &bytes)));
    assert_eq!(decode(&bytes, "a.png").unwrap().pixels, picture);
}

#[test]
fn a_damaged_picture_is_an_error() {
    let mut png = encode(red_blue(200, 100), ImageFormat::Png);
    let middle = png.len() / 2;
    png[middle] ^= 0xFF;
    let error = decode(&png, "a.png").unwrap_err();
    assert_eq!(error.code, ErrorCode::PatternLoading);
    assert!(error.to_string().starts_with("photo \"a.png\" is damaged ("), "{error}");
    assert_eq!(error.hint.unwrap(), "export it again as JPEG or PNG");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_bytes_make_the_reader_panic(
        format in prop::sample::select(&[ImageFormat::Jpeg, ImageFormat::Png, ImageFormat::WebP, ImageFormat::Tiff][..]),
        cut in 0usize..900,
        changes in prop::collection::vec((0usize..900, any::<u8>()), 0..8),
    ) {
        let mut bytes = encode(red_blue(24, 17), format);
        for (at, value) in changes {
            let length = bytes.len();
            bytes[at % length] = value;
        }
        let whole = cut % 3 == 0;
        bytes.truncate(if whole { bytes.len() } else { cut });
        if let Ok(out) = decode(&bytes, "a") {
            prop_assert!(out.pixels.width() > 0 && out.pixels.height() > 0);
        }
    }

    #[test]
    fn no_text_makes_the_entry_reader_panic(text in "[(){}:,\"a-z0-9 .MirrorOfilewdth]{0,40}") {
        let _ = ron_options().from_str::<PhotoEntry>(&text);
    }
}

/// White paper of A4 on a dark floor, 1,000 pixels a metre, photographed from straight above.
fn sheet() -> RgbImage {
    RgbImage::from_fn(900, 700, |x, y| {
        Rgb(if (500..797).contains(&x) && (150..360).contains(&y) { [235, 235, 230] } else { [70, 60, 50] })
    })
}

#[test]
fn a_sheet_of_paper_gives_the_scale_of_both_sides() {
    let folder = Folder::new("sheet", &[("a.png", encode(sheet(), ImageFormat::Png))]);
    let photos = folder.read(r#"{"front": (file: "a.png", scale: A4), "back": MirrorOf("front")}"#).unwrap();
    for side in ["front", "back"] {
        let photo = photos.get(side).unwrap();
        let scale = photo.px_per_metre.unwrap();
        let sheet = |p: &image::Rgb<u8>| p.0[0] > 150;
        let area = photo.pixels.pixels().filter(|p| sheet(p)).count() as f64 / (scale * scale);
        assert!((area / (0.21 * 0.297) - 1.0).abs() < 0.01, "{side}: {scale} {area}");
    }
}

#[test]
fn an_object_that_is_not_there_is_told_with_what_to_do() {
    let folder = Folder::new("no-card", &[("a.png", encode(red_blue(300, 200), ImageFormat::Png))]);
    let error = folder.read(r#"{"front": (file: "a.png", scale: BankCard)}"#).unwrap_err();
    assert_eq!(
        error.to_string(),
        "\"a.png\": no bank card was found; lay it flat beside the garment, whole in the frame, on a ground of another colour, and photograph from above"
    );
    assert_eq!(error.path, ["front", "scale"]);
    let twice = folder.read(r#"{"front": (file: "a.png", width: "52 cm", scale: A4)}"#).unwrap_err();
    assert_eq!(
        twice.to_string(),
        "photo \"front\": both width and scale are given; one of them fixes the scale"
    );
}

#[test]
fn a_photo_without_ground_shows_no_object() {
    let cut = RgbaImage::from_pixel(60, 60, Rgba([9, 9, 9, 0]));
    let folder = Folder::new("cut-scale", &[("a.png", encode(cut, ImageFormat::Png))]);
    let error = folder.read(r#"{"front": (file: "a.png", scale: Chessboard(square: "25 mm"))}"#).unwrap_err();
    assert_eq!(error.to_string(), "\"a.png\" has transparent pixels, and no ground on which an object lies");
    assert_eq!(error.hint.as_deref(), Some("give the photo as it was taken, or the garment's `width`"));
}

#[test]
fn a_scale_is_written_as_it_is_read() {
    let text = r#"{"front": (file: "a.png", scale: Chessboard(square: "25 mm"))}"#;
    let read = entries(text);
    let written = ron_options().to_string(&read).unwrap();
    assert_eq!(entries(&written), read, "{written}");
}

//! The texturer in a pipeline. With `KEEP_PICTURES=DIR` its pictures are kept there.

use std::path::Path;

/// Runs the vest with a texturer, as it is placed: what is painted on it is the same before it is
/// sewn.
fn dress(texturer: &str, out: &Path) {
    let mut registry = toile::registry();
    toile_ironed::register(&mut registry);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let vest = std::fs::read_to_string(root.join("pipelines/vest.ron")).unwrap();
    let (stages, _) = vest.split_once("    qualities: [").unwrap();
    let is_rest = |l: &&str| ["StaticEquilibrium(", "Subdivide("].iter().any(|s| l.trim().starts_with(s));
    let line = |l: &str| {
        if l.trim().starts_with("PhotoTexturer(") { format!("{texturer},\n") } else { format!("{l}\n") }
    };
    let unsewn: String = stages.lines().filter(|l| !is_rest(l)).map(line).collect();
    let text = (unsewn + ")\n")
        .replace("GridMesher(edge: \"16 mm\")", "GridMesher(edge: \"30 mm\")")
        .replace("Glb(), Obj(), Preview(), Report(),", "Preview(), Obj(),")
        .replace("samples/", &format!("{}/pipelines/samples/", root.display()));
    std::fs::create_dir_all(out).unwrap();
    let file = out.join("vest.ron");
    std::fs::write(&file, text).unwrap();
    let (mut said, mut told) = (Vec::new(), Vec::new());
    let arguments = ["toile", "run", file.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let code = toile::command_with(&registry, arguments, &mut said, &mut told);
    // Cloth that is not sewn misses quality limits; the pictures are what counts here.
    assert!(code == 0 || code == 4, "{}", String::from_utf8_lossy(&told));
}

/// Mean over the picture of how much a pixel differs from those 8 px away, grey levels.
fn unevenness(file: &Path) -> f64 {
    let image = image::open(file).unwrap().to_luma8();
    let (w, h) = (image.width() - 8, image.height() - 8);
    let at = |x: u32, y: u32| f64::from(image.get_pixel(x, y)[0]);
    let all = (0..h).flat_map(|y| (0..w).map(move |x| (x, y)));
    let sum: f64 = all.map(|(x, y)| (at(x, y) - at(x + 8, y)).abs() + (at(x, y) - at(x, y + 8)).abs()).sum();
    sum / f64::from(w * h)
}

#[test]
fn the_vest_is_ironed() {
    let dir = tempfile::tempdir().unwrap();
    let kept = std::env::var_os("KEEP_PICTURES").map(std::path::PathBuf::from);
    let out = kept.as_deref().unwrap_or(dir.path());
    dress("PhotoTexturer(light: Modulate)", &out.join("plain"));
    dress("Ironed()", &out.join("ironed"));
    let texture = |of: &str| out.join(of).join("garment_front.jpg");
    let (plain, ironed) = (unevenness(&texture("plain")), unevenness(&texture("ironed")));
    println!("unevenness {plain:.2}, ironed {ironed:.2} grey levels");
    assert!(ironed < 0.9 * plain, "{plain} became {ironed}");
}

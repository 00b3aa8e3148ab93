//! The commands that the guide tells people to run on their own files, with two files each that are
//! no sample: drawn here, of other cuts, sizes and colours. A template that depends on its sample
//! fails here.

pub(crate) mod flat;
pub(crate) mod photo;
pub(crate) mod solid;

use crate::readme::{passes, scratch};
use flat::{hip_skirt, skirt, top};
use std::path::Path;

/// A drawing as a CAD program writes it.
pub(crate) fn drawing() -> Vec<u8> {
    flat::dxf(&skirt(34.5, 64.0, 62.0))
}

/// The command stands in that page, word for word.
fn told(page: &str, command: &str) {
    let text = std::fs::read_to_string(crate::readme::root().join(page)).unwrap();
    assert!(text.lines().any(|line| line.trim() == command), "{page} does not tell: {command}");
}

/// Runs the page's commands one after the other with each of the files in the place of `own`; after
/// each file, `made` must be there.
fn with_each(page: &str, commands: &[&str], own: &str, files: [Vec<u8>; 2], made: &[&str]) {
    let dir = scratch();
    let cache = dir.path().join("cache");
    for bytes in files {
        std::fs::write(dir.path().join(own), bytes).unwrap();
        for command in commands {
            told(page, command);
            passes(command, dir.path(), &cache);
            confirm(dir.path());
        }
        for name in made {
            let file = dir.path().join(name);
            assert!(file.metadata().is_ok_and(|m| m.len() > 0), "{name} of {own} is not written");
            std::fs::remove_file(file).unwrap();
        }
    }
}

/// What a reader does between the commands: proposed seams are saved as `seams.ron`.
fn confirm(folder: &Path) {
    let proposed = folder.join("out/look/seams.ron");
    if proposed.is_file() {
        std::fs::rename(proposed, folder.join("seams.ron")).unwrap();
    }
}

const LOOK: [&str; 2] = ["out/mine/garment.glb", "out/mine/front.png"];

#[test]
fn a_garment_code_file() {
    with_each(
        "docs/guide/patterns.md",
        &[
            "toile run pipelines/pattern.ron --set 'pattern.file=\"my_specification.json\"' --until GarmentCode --keep --out out/look",
            "toile run pipelines/pattern.ron --set 'pattern.file=\"my_specification.json\"' --out out/mine",
        ],
        "my_specification.json",
        [flat::garment_code(&skirt(34.5, 62.0, 58.0), 107.0), flat::garment_code(&top(52.0, 62.0), 82.0)],
        &LOOK,
    );
}

#[test]
fn garments_that_are_worn_over_each_other() {
    let command = "toile run pipelines/outfit.ron --set 'pattern.garments=[\"inner_specification.json\", \"outer_specification.json\"]' --out out/mine";
    told("docs/guide/patterns.md", command);
    let dir = scratch();
    let cache = dir.path().join("cache");
    for (inner, outer) in
        [(skirt(34.5, 62.0, 58.0), top(56.0, 62.0)), (hip_skirt(34.0, 52.0, 60.0), top(54.0, 50.0))]
    {
        let lay = |name: &str, bytes| std::fs::write(dir.path().join(name), bytes).unwrap();
        lay("inner_specification.json", flat::garment_code(&inner, 107.0));
        lay("outer_specification.json", flat::garment_code(&outer, 82.0));
        passes(command, dir.path(), &cache);
        for name in LOOK {
            std::fs::remove_file(dir.path().join(name)).unwrap();
        }
    }
}

#[test]
fn a_drawing() {
    with_each(
        "docs/guide/patterns.md",
        &[
            "toile run pipelines/pattern.ron --set 'pattern=SvgPattern(file: \"mine.svg\")' --until SvgPattern --keep --out out/look",
            "toile run pipelines/pattern.ron --set 'pattern=SvgPattern(file: \"mine.svg\", seams: \"seams.ron\")' --out out/mine",
        ],
        "mine.svg",
        [flat::svg(&skirt(34.5, 60.0, 50.0)), flat::svg(&hip_skirt(34.0, 52.0, 60.0))],
        &LOOK,
    );
}

#[test]
fn a_file_of_a_cad_program() {
    with_each(
        "docs/guide/patterns.md",
        &[
            "toile run pipelines/pattern.ron --set 'pattern=DxfPattern(file: \"mine.dxf\")' --until DxfPattern --keep --out out/look",
            "toile run pipelines/pattern.ron --set 'pattern=DxfPattern(file: \"mine.dxf\", seams: \"seams.ron\")' --out out/mine",
        ],
        "mine.dxf",
        [flat::dxf(&skirt(34.5, 64.0, 62.0)), flat::dxf(&hip_skirt(34.5, 56.0, 55.0))],
        &LOOK,
    );
}

#[test]
fn a_photo() {
    with_each(
        "docs/guide/own-garment.md",
        &[
            "toile run pipelines/photo.ron --set 'photos.front.file=\"mine.jpg\"' --set 'photos.front.width=\"76 cm\"' --out out/mine",
        ],
        "mine.jpg",
        [photo::boxy_tee(), photo::slim_tee()],
        &LOOK,
    );
}

#[test]
fn a_photo_of_a_kind_that_is_stated() {
    with_each(
        "docs/guide/photos.md",
        &[
            "toile run pipelines/photo_skirt.ron --set 'photos.front.file=\"skirt.jpg\"' --set 'photos.front.width=\"62 cm\"' --out out/mine",
        ],
        "skirt.jpg",
        [photo::skirt(18.5, 52.0), photo::skirt(17.5, 60.0)],
        &LOOK,
    );
}

#[test]
fn a_garment_to_flatten() {
    with_each(
        "docs/guide/flatten.md",
        &[
            "toile run pipelines/flatten.ron --set 'garment.file=\"dress.obj\"' --set garment.unit=Centimetres --out out/dress",
        ],
        "dress.obj",
        [solid::tube([38.0, 30.0], 60.0), solid::tube([24.0, 29.0], 45.0)],
        &["out/dress/pattern.pdf", "out/dress/pattern.svg", "out/dress/flat.json"],
    );
}

#[test]
#[ignore = "slow: .ci/wide"]
fn a_body() {
    let dir = scratch();
    let cache = dir.path().join("cache");
    let body = "toile run pipelines/pattern.ron --set 'body=BodyObj(file: \"me.obj\")' --out out/mine";
    told("docs/guide/patterns.md", body);
    for figure in
        ["height: \"168 cm\", bust: \"86 cm\"", "height: \"175 cm\", bust: \"90 cm\", waist: \"74 cm\""]
    {
        let make = format!(
            "toile run pipelines/pattern.ron --set 'body=Mannequin({figure})' --until Mannequin --keep --out out/body && cp out/body/stages/Mannequin/*.obj me.obj"
        );
        passes(&make, dir.path(), &cache);
        passes(body, dir.path(), &cache);
    }
}

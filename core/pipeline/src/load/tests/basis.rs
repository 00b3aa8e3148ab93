//! What a quality's claim was measured for: what changes its digest, and what does not.

use super::super::{Basis, Changes, Quality, Standing, load_with};
use super::*;

/// The vest with a quality that was measured for it as it stands, between its qualities and its
/// stages.
const SET: &str = "stages.GridMesher.edge=\"24 mm\"";

fn with(text: &str, entry: &str) -> String {
    let field =
        format!("    qualities: [Quality(name: \"Draft\", max_error: \"2 mm\", {entry})],\n    stages: [");
    text.replace("    stages: [", &field)
}

fn loaded(text: &str, base: &Path) -> Pipeline {
    let changes = Changes { quality: Some("Draft"), ..Changes::default() };
    load_with(text, "vest.ron", base, &kit::registry(), &changes).unwrap()
}

/// What the claim is worth for a text whose quality has this basis.
fn standing(text: &str, set: &str, basis: &str, base: &Path) -> Standing {
    let entry = format!("set: [{set:?}], measured: \"so\", measured_for: \"{basis}\"");
    let pipeline = loaded(&with(text, &entry), base);
    pipeline.qualities[0].standing(&pipeline)
}

fn basis(text: &str, base: &Path) -> String {
    Basis::of(&loaded(&with(text, &format!("set: [{SET:?}]")), base)).to_string()
}

#[test]
fn an_edit_that_acts_on_the_garment_voids_the_claim() {
    let base = Path::new("pipelines");
    let own = basis(kit::VEST, base);
    assert_eq!(standing(kit::VEST, SET, &own, base), Standing::Holds);
    for (from, to) in [
        ("GridMesher(edge: \"12 mm\")", "DelaunayMesher(id: \"GridMesher\", edge: \"12 mm\")"),
        ("\"cotton poplin\"", "\"denim\""),
        ("height: \"172 cm\"", "height: \"171 cm\""),
        ("low: 20", "low: 21"),
        ("Taubin(),", "Laplacian(lambda: 0.5),"),
        ("        Taubin(),\n", ""),
        ("width: \"52 cm\"", "width: \"53 cm\""),
    ] {
        let edited = kit::VEST.replacen(from, to, 1);
        assert_ne!(edited, kit::VEST);
        assert_eq!(standing(&edited, SET, &own, base), Standing::OtherPipeline, "{to}");
    }
    // Its own settings were measured, too.
    assert_eq!(standing(kit::VEST, "stages.GridMesher.edge=\"23 mm\"", &own, base), Standing::OtherPipeline);
}

#[test]
fn an_edit_that_does_not_act_on_it_leaves_the_claim() {
    let base = Path::new("pipelines");
    let own = basis(kit::VEST, base);
    for (from, to) in [
        ("// A vest.", "// Another comment."),
        ("name: \"vest\"", "name: \"mine\""),
        ("        Otsu(),\n", "\n\n   Otsu( /* as it is */ ),\n"),
        ("Otsu()", "Otsu(bias: 0.0)"),
        ("Otsu()", "Otsu(id: \"Mine\")"),
        ("Glb(), Report(),", "Report(),"),
        // The quality sets it.
        ("edge: \"12 mm\"", "edge: \"13 mm\""),
    ] {
        let edited = kit::VEST.replacen(from, to, 1);
        assert_ne!(edited, kit::VEST);
        assert_eq!(standing(&edited, SET, &own, base), Standing::Holds, "{to}");
    }
}

#[test]
fn photos_count_by_their_content() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, content: &str| std::fs::write(dir.path().join(name), content).unwrap();
    write("front.jpg", "one");
    write("back.jpg", "two");
    let own = basis(kit::VEST, dir.path());
    write("mine.jpg", "one");
    let renamed = kit::VEST.replace("front.jpg", "mine.jpg");
    assert_eq!(standing(&renamed, SET, &own, dir.path()), Standing::Holds);
    write("front.jpg", "another");
    assert_eq!(standing(kit::VEST, SET, &own, dir.path()), Standing::OtherPipeline);
}

#[test]
fn versions_of_stages_are_told_apart_from_edits() {
    let base = Path::new("pipelines");
    let own = basis(kit::VEST, base);
    let other = format!("{}-{}", &own[..16], "0".repeat(16));
    assert_eq!(standing(kit::VEST, SET, &other, base), Standing::OtherStages);
}

#[test]
fn what_is_not_known_is_said() {
    let words = |entry: &str| {
        let pipeline = loaded(&with(kit::VEST, entry), Path::new("pipelines"));
        let quality = &pipeline.qualities[0];
        quality.words(quality.standing(&pipeline))
    };
    assert_eq!(words("set: []"), "Draft (2 mm, not measured)");
    assert_eq!(words("set: [], measured: \"so\""), "Draft (2 mm, not known what it was measured for)");
    let of = |digest: char| format!("set: [], measured_for: \"{0}-{0}\"", digest.to_string().repeat(16));
    assert_eq!(words(&of('a')), "Draft (2 mm, measured for another pipeline)");
}

#[test]
fn a_basis_that_is_none_is_a_fault_at_its_place() {
    let text = with(kit::VEST, "set: [], measured_for: \"yesterday\"");
    assert_eq!(
        faults(&text),
        "vest.ron:11:82: `measured_for`: it is two digests of 16 digits with `-` between them, as `toile tune` writes it"
    );
}

#[test]
fn what_is_written_reads_back() {
    let basis: Basis = basis(kit::VEST, Path::new("pipelines")).parse().unwrap();
    let quality = Quality::new(
        "Draft".into(),
        toile_core::Length::mm(2.0),
        vec![SET.parse().unwrap()],
        Some("so".into()),
    );
    let text = super::super::fill_qualities(kit::VEST, &[quality.measured_for(basis.clone())]).unwrap();
    assert!(
        text.contains(&format!("            measured: \"so\",\n            measured_for: \"{basis}\"),\n")),
        "{text}"
    );
    assert_eq!(loaded(&text, Path::new("pipelines")).qualities[0].basis, Some(basis));
}

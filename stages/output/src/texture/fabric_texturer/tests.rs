//! Cloth by name, its relief and its variants.

#![allow(clippy::unwrap_used)]

use super::*;
use toile_core::testkit::dress;

fn texturer(texture: FabricTexture) -> FabricTexturer {
    let text = format!("(texture: {texture:?}, size: 64, body: Hide, edge: \"0 mm\")");
    toile_core::param::ron_options().from_str(&text).unwrap()
}

fn fault(texturer: &FabricTexturer) -> (String, String) {
    let e = texturer.fault().unwrap();
    (e.message, e.hint.unwrap())
}

#[test]
fn every_panel_gets_its_cloth_along_the_grain_once_a_kind() {
    let garment = dress::garment();
    let model = texturer(FabricTexture::Twill).run(&garment, None, None, &Context::quiet()).unwrap();
    assert_eq!((model.meshes.len(), model.textures.len()), (garment.panels.len(), 1));
    assert!(model.textures[0].repeats && model.textures[0].name == "twill");
    let (uv, flat) = (&model.meshes[0].uv, &garment.rest[garment.panels[0].vertices.clone()]);
    // 64 mm a repeat; up the grain is up the picture.
    let rises = f64::from(uv[0][1] - uv[uv.len() - 1][1]);
    assert!((rises - (flat[flat.len() - 1].y - flat[0].y) / 0.064).abs() < 1e-4);
}

#[test]
fn the_fabrics_name_says_what_it_looks_like() {
    let shows = |name: &str| texturer(FabricTexture::Auto).shows(name);
    let told =
        ["denim", "cotton twill", "Cotton Jersey", "rib knit", "ripstop nylon", "silk charmeuse"].map(shows);
    use FabricTexture::{Denim, Jersey, Plain, Rib, Twill};
    assert_eq!(told, [Denim, Twill, Jersey, Rib, Plain, Plain]);
}

#[test]
fn the_garments_of_an_outfit_have_their_own_colours() {
    let mut garment = dress::garment();
    garment.panels[1].layer = 1;
    let two = FabricTexturer {
        colours: vec!["#f2f0ea".into(), "#7a2f3a".into()],
        ..texturer(FabricTexture::Plain)
    };
    let model = two.run(&garment, None, None, &Context::quiet()).unwrap();
    let names: Vec<&str> = model.textures.iter().map(|t| t.name.as_str()).collect();
    assert_eq!(names, ["plain #f2f0ea", "plain #7a2f3a"]);
    assert_eq!((model.materials[0].texture, model.materials[1].texture), (Some(0), Some(1)));
    let red = FabricTexturer { variants: BTreeMap::from([("red".into(), "#a03028".into())]), ..two };
    assert_eq!(fault(&red).0, "`variants` have one colour, the garments of an outfit have several");
    let wrong = FabricTexturer { colours: vec!["white".into()], ..texturer(FabricTexture::Plain) };
    assert_eq!(fault(&wrong).0, "\"white\" is no colour");
}

#[test]
fn what_does_nothing_is_refused() {
    let striped = FabricTexturer { repeat: Some(Length::mm(10.0)), ..texturer(FabricTexture::Jersey) };
    let hint = "it is for checks and stripes: leave it out, or choose one of these";
    assert_eq!(fault(&striped), ("`repeat` does nothing with `texture: Jersey`".into(), hint.into()));
    let two = FabricTexturer { second: Some("#ffffff".into()), ..texturer(FabricTexture::Plain) };
    assert_eq!(fault(&two).0, "`second` does nothing with `texture: Plain`");
    // No panel of the garment is of denim.
    let auto = FabricTexturer { texture: FabricTexture::Auto, ..two };
    let e = auto.run(&dress::garment(), None, None, &Context::quiet()).unwrap_err();
    assert_eq!(e.message, "`second` does nothing with `texture: Auto`, which found no denim");
    assert_eq!(e.hint.unwrap(), "it is for denim, checks and stripes: leave it out, or choose one of these");
}

#[test]
fn a_normal_map_of_the_same_threads_lies_beside_the_cloth() {
    let woven = FabricTexturer { detail: FabricDetail::Weave, ..texturer(FabricTexture::Twill) };
    let model = woven.run(&dress::garment(), None, None, &Context::quiet()).unwrap();
    let names: Vec<&str> = model.textures.iter().map(|t| t.name.as_str()).collect();
    assert_eq!(names, ["twill", "twill normals"]);
    assert!(model.is_normal_map(1) && !model.is_normal_map(0));
    assert!(model.materials.iter().all(|m| (m.texture, m.normal_texture) == (Some(0), Some(1))));
    let idle = FabricTexturer { strength: Some(2.0), ..texturer(FabricTexture::Twill) };
    let told = ("`strength` does nothing with `detail: None`", "leave it out, or give `detail: Weave`");
    assert_eq!(fault(&idle), (told.0.into(), told.1.into()));
}

#[test]
fn variants_are_looks_in_other_colours_of_one_relief() {
    let variants = [("navy", "#001133"), ("red", "#a03028")].map(|(n, c)| (n.to_owned(), c.to_owned()));
    let detail = FabricDetail::Weave;
    let many = FabricTexturer { variants: variants.into(), detail, ..texturer(FabricTexture::Plain) };
    let (garment, body) = (dress::garment(), dress::body());
    let many = FabricTexturer { body: BodyShown::Show, ..many };
    let model = many.run(&garment, None, Some(&body), &Context::quiet()).unwrap();
    let names: Vec<&str> = model.variants.iter().map(|v| v.name.as_str()).collect();
    assert_eq!(names, ["original", "navy", "red"]);
    let names: Vec<&str> = model.textures.iter().map(|t| t.name.as_str()).collect();
    assert_eq!(names, ["plain", "plain normals", "plain navy", "plain red"]);
    let panels = garment.panels.len();
    for (variant, texture) in model.variants.iter().zip([0, 2, 3]) {
        let worn = variant.materials[..panels].iter().map(|m| &model.materials[*m]);
        assert!(worn.clone().all(|m| m.texture == Some(texture) && m.normal_texture == Some(1)));
        assert_eq!(variant.materials[panels], panels, "the body is the same in all");
    }
    assert_eq!(model.check(), Ok(()));
}

#[test]
fn a_variant_has_a_name_and_a_colour() {
    let with = |name: &str, colour: &str| {
        let variants = BTreeMap::from([(name.to_owned(), colour.to_owned())]);
        fault(&FabricTexturer { variants, ..texturer(FabricTexture::Plain) })
    };
    let hint = "a variant is a name with a colour, such as \"red\": \"#a03028\"";
    let own = "the variant \"original\" has the name of the model's own look, or none";
    assert_eq!(with("original", "#ffffff"), (own.into(), hint.into()));
    assert_eq!(with("red", "red").0, "\"red\" is no colour");
}

#[test]
fn a_colour_is_six_digits() {
    let red = FabricTexturer { colour: Some("red".into()), ..texturer(FabricTexture::Plain) };
    let hint = "a colour is # and six digits of 0 to 9 and a to f: red, green and blue, such as \"#2b3f5c\"";
    assert_eq!(fault(&red), ("\"red\" is no colour".into(), hint.into()));
    assert_eq!(parse("#ff0000").unwrap(), [1.0, 0.0, 0.0]);
    assert!(parse("#ff00é").is_err());
}

/// The suite's garment with its panels, whose edges have names.
fn with_panels(texturer: &FabricTexturer) -> Result<Model, StageError> {
    let garment = dress::garment();
    let panels = garment.panels.iter().map(|p| (p.name.clone(), dress::garment_panel())).collect();
    texturer.run(&garment, Some(panels), None, &Context::quiet())
}

#[test]
fn an_edge_that_no_panel_has_is_warned_of_and_the_garment_is_dressed() {
    let texturer = FabricTexturer {
        ribs: widths(&[("collar", 20.0), ("neck", 20.0)]),
        ..texturer(FabricTexture::Plain)
    };
    let garment = dress::garment();
    let panels = garment.panels.iter().map(|p| (p.name.clone(), dress::garment_panel())).collect();
    let cx = Context::quiet();
    let model = texturer.run(&garment, Some(panels), None, &cx).unwrap();
    assert_eq!(model.meshes.len(), 2);
    let told = "no panel has an edge \"collar\" to finish; the edges are hem, neck, shoulder_left, shoulder_right, side_left, side_right; a panel's own is `panel.edge`";
    assert_eq!(cx.take_remarks().warnings, [told]);
}

fn widths(given: &[(&str, f64)]) -> BTreeMap<String, Length> {
    given.iter().map(|(name, mm)| ((*name).to_owned(), Length::mm(*mm))).collect()
}

#[test]
fn a_panel_with_a_finished_edge_has_a_picture_of_its_own() {
    let names = |model: &Model| model.textures.iter().map(|t| t.name.clone()).collect::<Vec<_>>();
    let (detail, plain) = (FabricDetail::Weave, texturer(FabricTexture::Jersey));
    let one = FabricTexturer { ribs: widths(&[("front.neck", 20.0)]), detail, ..plain.clone() };
    let model = with_panels(&one).unwrap();
    assert_eq!(names(&model), ["jersey", "front", "jersey normals", "front normals"]);
    let looks = model.materials.iter().map(|m| (m.name.as_str(), m.texture, m.normal_texture));
    assert_eq!(looks.collect::<Vec<_>>(), [("front", Some(1), Some(3)), ("back", Some(0), Some(2))]);
    assert!(
        !model.textures[1].repeats && model.meshes[0].uv.iter().flatten().all(|c| (0.0..=1.0).contains(c))
    );
    let variants = BTreeMap::from([("red".to_owned(), "#a03028".to_owned())]);
    let both = FabricTexturer { stitches: widths(&[("hem", 25.0)]), variants, ..plain };
    let model = with_panels(&both).unwrap();
    assert_eq!(names(&model), ["jersey", "front", "back", "jersey red", "front red", "back red"]);
    assert_eq!(model.check(), Ok(()));
}

#[test]
fn edges_that_have_two_finishes_or_no_panels_are_refused() {
    let told = |ribs: &[(&str, f64)], stitches: &[(&str, f64)]| {
        let (ribs, stitches) = (widths(ribs), widths(stitches));
        let e =
            with_panels(&FabricTexturer { ribs, stitches, ..texturer(FabricTexture::Plain) }).unwrap_err();
        (e.message, e.hint.unwrap())
    };
    assert_eq!(
        told(&[("neck", 20.0)], &[("front.neck", 5.0)]),
        ("the edge `front.neck` has two finishes".into(), "name it once, in `ribs` or in `stitches`".into())
    );
    let ribbed = FabricTexturer { ribs: widths(&[("neck", 20.0)]), ..texturer(FabricTexture::Plain) };
    let e = ribbed.run(&dress::garment(), None, None, &Context::quiet()).unwrap_err();
    assert_eq!(e.message, "no stage before it gives panels, whose edges could be looked up");
    assert_eq!(e.hint.unwrap(), "let a mesher stand before it, or leave `ribs` and `stitches` out");
}

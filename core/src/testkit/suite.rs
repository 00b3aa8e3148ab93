//! The inputs that stages are run on: a few whole scenes, and hard cases of images, outlines and
//! panels.
//!
//! A scene holds what belongs together: a photo with its mask and its outline. A card's cases are
//! the scenes that hold what its ports take; what a scene does not hold comes from
//! [`dress`](super::dress).

use super::{capsules, dress, shapes};
use crate::RunLog;
use crate::artifact::*;
use crate::{Arity, Card, InPort, Inputs, PortValue, Role};
use image::{GrayImage, Luma, RgbImage};
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock};

/// Inputs for one run, in the order of a card's ports.
#[derive(Debug, Clone)]
pub struct Case {
    /// What they are: `a belt of 1 cm`.
    pub name: String,
    /// The values.
    pub inputs: Inputs,
    /// True where a stage may well refuse it.
    pub hard: bool,
}

type NamedArtifact = (&'static str, Arc<dyn Artifact>);

/// Things that belong together.
struct ExampleScene {
    name: &'static str,
    hard: bool,
    holds: BTreeMap<Kind, Vec<NamedArtifact>>,
}

impl ExampleScene {
    fn new(name: &'static str, hard: bool) -> Self {
        ExampleScene { name, hard, holds: BTreeMap::new() }
    }

    fn with<T: ArtifactType>(mut self, entry: &'static str, artifact: T) -> Self {
        self.holds.entry(T::KIND).or_default().push((entry, Arc::new(artifact)));
        self
    }

    /// Front and back alike.
    fn both<T: ArtifactType + Clone>(self, artifact: T) -> Self {
        self.with("back", artifact.clone()).with("front", artifact)
    }
}

/// Left and right exchanged in the edges' names: the back is seen from behind.
fn behind(outline: &Outline) -> Outline {
    let mut out = outline.clone();
    out.edges.iter_mut().for_each(|e| e.name = other_side(&e.name));
    out
}

fn other_side(name: &str) -> String {
    match Hand::split(name) {
        (stem, Some(hand)) => hand.other().name(stem),
        _ => name.to_owned(),
    }
}

/// The garment's panel as the back of it.
fn back_panel() -> Panel {
    let mut panel = dress::garment_panel();
    panel.edges.iter_mut().for_each(|e| e.name = other_side(&e.name));
    panel
}

/// Photos, masks and named outlines of a garment.
fn garment(name: &'static str, front: &Outline, back: &Outline) -> ExampleScene {
    let framed = |o: &Outline| Outline { frame: Some(shapes::frame(o)), ..o.clone() };
    let (front_photo, front_mask) = shapes::photo_of(front);
    let (back_photo, back_mask) = shapes::photo_of(back);
    ExampleScene::new(name, false)
        .with("back", back_photo)
        .with("front", front_photo)
        .with("back", back_mask)
        .with("front", front_mask)
        .with("back", framed(&behind(back)))
        .with("front", framed(front))
}

fn images(name: &'static str, photo: RgbImage, mask: GrayImage) -> ExampleScene {
    ExampleScene::new(name, true).both(shapes::photo_from(photo)).both(shapes::mask_from(mask))
}

fn outlines(name: &'static str, outline: &Outline) -> ExampleScene {
    ExampleScene::new(name, true).with("back", behind(outline)).with("front", outline.clone())
}

fn scenes() -> &'static [ExampleScene] {
    static SCENES: LazyLock<Vec<ExampleScene>> = LazyLock::new(|| {
        let (vest, low, tshirt) = (shapes::vest(0.5), shapes::vest(0.62), shapes::tshirt());
        let noise = shapes::noisy_photo(40, 30).pixels;
        let thresholded =
            GrayImage::from_fn(40, 30, |x, y| Luma([if noise.get_pixel(x, y)[0] > 127 { 255 } else { 0 }]));
        let point = |q: [[f64; 2]; 3]| q.map(|[x, y]| Point2::new(x, y)).to_vec();
        vec![
            garment("a vest", &vest, &low).with("back", back_panel()).with("front", dress::garment_panel()),
            garment("a T-shirt", &tshirt, &tshirt),
            ExampleScene::new("a vest without names", false)
                .with("back", shapes::unnamed(&low))
                .with("front", shapes::unnamed(&vest)),
            ExampleScene::new("a T-shirt without names", false).both(shapes::unnamed(&tshirt)),
            images("one pixel", RgbImage::new(1, 1), GrayImage::from_pixel(1, 1, Luma([255]))),
            images("all black", RgbImage::new(64, 48), GrayImage::new(64, 48)),
            images("noise", noise.as_ref().clone(), thresholded),
            images("a row of pixels", RgbImage::new(200, 1), GrayImage::from_pixel(200, 1, Luma([255]))),
            outlines("a star", &shapes::star()),
            outlines("a disc with a hole", &shapes::holed()),
            outlines("a belt of 1 cm", &shapes::sliver()),
            outlines("a skirt with a dart and a fold", &shapes::darted()),
            outlines("a vest of 5 mm", &shapes::scaled(&vest, 0.01)),
            outlines("a vest of 50 m", &shapes::scaled(&vest, 100.0)),
            outlines(
                "a triangle",
                &shapes::plain(point([[0.0, 0.0], [0.3, 0.0], [0.0, 0.2]]), vec![0, 1, 2]),
            ),
            ExampleScene::new("a ring", false).both(shapes::ring()),
            ExampleScene::new("a panel of 1 cm", true).both(shapes::panel(3, 3, 0.01, 0.01)),
            ExampleScene::new("a strip", true).both(shapes::panel(40, 1, 1.0, 0.004)),
        ]
    });
    &SCENES
}

/// A value of a port that holds `artifact`, alone or as front and back.
pub fn value(port: &InPort, artifact: &Arc<dyn Artifact>) -> PortValue {
    match port.arity {
        Arity::All => {
            let set = ["back", "front"].map(|name| (name.to_owned(), artifact.clone()));
            PortValue::Set(port.kind, set.into())
        }
        Arity::One | Arity::Each => PortValue::One(artifact.clone()),
    }
}

fn scene_value(scene: &ExampleScene, port: &InPort) -> Option<PortValue> {
    let entries = scene.holds.get(&port.kind)?;
    match port.arity {
        Arity::All => {
            let set = entries.iter().map(|(name, a)| ((*name).to_owned(), a.clone())).collect();
            Some(PortValue::Set(port.kind, set))
        }
        Arity::One | Arity::Each => entries.last().map(|(_, a)| PortValue::One(a.clone())),
    }
}

type MakeExample = fn() -> Arc<dyn Artifact>;
/// A kind with an artifact that is made where it is first requested.
type Own = (Kind, LazyLock<Arc<dyn Artifact>, MakeExample>);

/// Artifacts for ports that no scene fills, one per kind. They are made once per process: the
/// contracts of all cards use them some thousand times.
fn own() -> &'static [Own] {
    static OWN: LazyLock<Vec<Own>> = LazyLock::new(|| {
        let all: [(Kind, MakeExample); 14] = [
            (Body::KIND, || Arc::new(dress::body())),
            (Fabric::KIND, || Arc::new(dress::fabric())),
            (SewingPlan::KIND, || Arc::new(dress::plan())),
            (Pattern::KIND, || Arc::new(dress::pattern())),
            (Garment::KIND, || Arc::new(dress::moved_garment())),
            (Collider::KIND, || Arc::new(capsules::collider())),
            (Phases::KIND, || Arc::new(dress::phases())),
            (Model::KIND, || Arc::new(dress::model())),
            (RunLog::KIND, || Arc::new(RunLog { pipeline: "suite".into(), ..RunLog::default() })),
            (Figures::KIND, || Arc::new(Figures::default())),
            (Photo::KIND, || Arc::new(shapes::photo())),
            (Mask::KIND, || Arc::new(shapes::mask())),
            (Outline::KIND, || Arc::new(shapes::outline())),
            (Panel::KIND, || Arc::new(dress::garment_panel())),
        ];
        all.map(|(kind, make)| (kind, LazyLock::new(make))).into()
    });
    &OWN
}

/// True for kinds of which the suite holds something.
pub fn is_known(kind: Kind) -> bool {
    own().iter().any(|(known, _)| *known == kind)
}

/// What stands on a port that no scene fills; nothing for kinds that the suite does not know.
pub fn default_value(port: &InPort) -> Option<PortValue> {
    own().iter().find(|(kind, _)| *kind == port.kind).map(|(_, artifact)| value(port, artifact))
}

/// What stands on a port of that card: a draper gets a garment that is sewn.
pub fn own_value(card: &Card, port: &InPort) -> Option<PortValue> {
    if card.role == Role::Draper && port.kind == Garment::KIND {
        let sewn: Arc<dyn Artifact> = Arc::new(dress::sewn_garment());
        return Some(value(port, &sewn));
    }
    default_value(port)
}

/// What a stage that is being stopped works on: large enough that most take longer than the time
/// they have.
pub fn large_value(card: &Card, port: &InPort) -> Option<PortValue> {
    let artifact: Arc<dyn Artifact> = match port.kind {
        k if k == Photo::KIND => Arc::new(enlarged(&shapes::photo())),
        k if k == Mask::KIND => Arc::new(enlarged_mask(&shapes::mask())),
        k if k == Outline::KIND => Arc::new(shapes::scaled(&shapes::outline(), 3.0)),
        k if k == Panel::KIND && port.arity != Arity::All => Arc::new(shapes::panel(300, 300, 3.0, 3.0)),
        _ => return own_value(card, port),
    };
    Some(value(port, &artifact))
}

/// How much larger photos are that a stage is stopped on.
const ENLARGED: u32 = 12;

fn enlarged(photo: &Photo) -> Photo {
    let (w, h) = photo.pixels.dimensions();
    let at = |x: u32, y: u32| {
        let grain = ((x * 7919 + y * 104_729) % 17) as u8;
        image::Rgb(photo.pixels.get_pixel(x / ENLARGED, y / ENLARGED).0.map(|v| v.saturating_add(grain)))
    };
    let pixels = RgbImage::from_fn(w * ENLARGED, h * ENLARGED, at);
    Photo { px_per_metre: photo.px_per_metre.map(|s| s * f64::from(ENLARGED)), ..photo.with_pixels(pixels) }
}

fn enlarged_mask(mask: &Mask) -> Mask {
    let (w, h) = mask.pixels.dimensions();
    let at = |x: u32, y: u32| *mask.pixels.get_pixel(x / ENLARGED, y / ENLARGED);
    shapes::mask_from(GrayImage::from_fn(w * ENLARGED, h * ENLARGED, at))
}

/// The empty artifact of a kind; nothing where the suite knows none.
pub fn empty_value(port: &InPort) -> Option<PortValue> {
    empty(port.kind).map(|make| value(port, &make()))
}

/// True for kinds of which the suite knows an empty artifact.
pub fn has_empty(kind: Kind) -> bool {
    empty(kind).is_some()
}

fn empty(kind: Kind) -> Option<MakeExample> {
    Some(match kind {
        k if k == Photo::KIND => || Arc::new(shapes::photo_from(RgbImage::new(0, 0))),
        k if k == Mask::KIND => || Arc::new(shapes::mask_from(GrayImage::new(0, 0))),
        k if k == Outline::KIND => || Arc::new(shapes::nothing()),
        k if k == Panel::KIND => || {
            Arc::new(Panel {
                positions: vec![],
                triangles: vec![],
                boundary: vec![],
                edges: vec![],
                photo_px: vec![],
                ..dress::garment_panel()
            })
        },
        k if k == Garment::KIND => || Arc::new(dress::no_garment()),
        k if k == Body::KIND => || {
            Arc::new(Body {
                positions: vec![],
                triangles: vec![],
                landmarks: BTreeMap::new(),
                measurements: BTreeMap::new(),
            })
        },
        _ => return None,
    })
}

/// Every case for a card; none where a required port takes a kind that the suite does not know.
pub fn cases(card: &Card) -> Vec<Case> {
    let wants =
        |scene: &&ExampleScene| card.inputs.iter().any(|p| !p.optional && scene.holds.contains_key(&p.kind));
    let mut all: Vec<Case> =
        scenes().iter().filter(wants).filter_map(|scene| case(card, Some(scene))).collect();
    if all.is_empty() {
        all.extend(case(card, scenes().first()));
    }
    // A scene that fills some ports and leaves others to things of another size is a hard case.
    all.extend(bare(card));
    all
}

fn case(card: &Card, scene: Option<&ExampleScene>) -> Option<Case> {
    let pictured = |p: &&InPort| [Photo::KIND, Mask::KIND, Outline::KIND, Panel::KIND].contains(&p.kind);
    let fill = |port: &InPort| scene.and_then(|s| scene_value(s, port)).or_else(|| own_value(card, port));
    let inputs: Vec<Option<PortValue>> = card.inputs.iter().map(fill).collect();
    let missing = inputs.iter().zip(&card.inputs).any(|(v, p)| v.is_none() && !p.optional);
    // Photo and mask of one scene belong together; another's mask does not fit.
    let own = |p: &InPort| scene.is_some_and(|s| s.holds.contains_key(&p.kind));
    let mixed = card.inputs.iter().filter(pictured).filter(|p| !p.optional).any(|p| !own(p));
    let name = scene.map_or("the suite's own", |s| s.name).to_owned();
    let hard = scene.is_some_and(|s| s.hard);
    (!missing && !mixed).then_some(Case { name, inputs: Inputs(inputs), hard })
}

/// The first case without anything on its optional ports.
fn bare(card: &Card) -> Option<Case> {
    // A garment that no body and no end stops falls for as long as its solver has patience.
    let falls = card.inputs.iter().any(|p| p.kind == Garment::KIND)
        && card.outputs.iter().any(|p| p.kind == Garment::KIND);
    if falls || !card.inputs.iter().any(|p| p.optional) {
        return None;
    }
    let full = case(card, scenes().first())?;
    let keep = |(v, p): (Option<PortValue>, &InPort)| if p.optional { None } else { v };
    let inputs = full.inputs.0.into_iter().zip(&card.inputs).map(keep).collect();
    Some(Case { name: "only what is required".into(), inputs: Inputs(inputs), hard: true })
}

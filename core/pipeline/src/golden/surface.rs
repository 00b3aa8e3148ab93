//! Places of a garment's surface: where points of the flat pattern lie in space.
//!
//! A drape may change by centimetres while its area, its box and its strains stay what they were,
//! so a sheet keeps some hundreds of points of the surface as well. A point is named by its place
//! in the flat pattern, which no mesh changes, and the sheet's own places are looked up in the
//! garment that is held against it.
//!
//! Method: the places of a panel are the first of the golden-ratio sequence of the plane (Roberts
//! 2018), laid over the panel's box, that lie on it; each panel has a share of [`PLACES`] by its
//! flat area. Cost: linear in the triangles. Limits: what lies between the places is not seen; a
//! panel without area has none.

use super::Arithmetic;
use toile_core::artifact::{Garment, GarmentPanel, Located, Locator, Point2, quantile};

/// Places of a garment, all panels together.
const PLACES: f64 = 240.0;
/// The least number of places of a panel.
const LEAST: usize = 12;
/// Points of the sequence that are tried for each place that is wanted: a panel may fill little of
/// its box.
const TRIES: usize = 50;
/// Inverse powers of the plastic number.
const STEP: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053];
/// A place may lie this far beyond the mesh that it is looked up in (its border is made of other
/// chords), metres.
const REACH: f64 = 0.01;
/// Places stand in a sheet in tenths of a millimetre of the pattern, metres.
const GRAIN: f64 = 1e-4;

/// On a machine of equal arithmetic. Equal code gives equal bits there, so this is only what a
/// change may do to be a remark.
const HERE: PlaceTolerance = PlaceTolerance { within_mm: 0.2, most_mm: 1.0 };
/// On a machine of other arithmetic. Folds and friction have many states of rest: sums that are
/// rounded otherwise moved the vest by 1.2 mm at 95 % and 9 mm at most (docs/reference/goldens.md).
const ELSEWHERE: PlaceTolerance = PlaceTolerance { within_mm: 3.0, most_mm: 20.0 };
/// Half a unit of the last place that a sheet shows of each coordinate, together, mm.
const SHEET_ROUNDING: f64 = 0.01;

/// How far the places of a surface may move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaceTolerance {
    /// 95 % of the places move by no more, mm.
    pub within_mm: f64,
    /// No place moves by more, mm.
    pub most_mm: f64,
}

/// Where points of a garment's pattern lie, and how far they may move.
#[derive(Debug, Clone, PartialEq)]
pub struct GoldenSurface {
    /// On a machine of the golden's arithmetic.
    pub here: PlaceTolerance,
    /// On another.
    pub elsewhere: PlaceTolerance,
    /// Panel by panel.
    pub panels: Vec<PanelPlaces>,
}

/// The places of a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct PanelPlaces {
    /// The panel's name.
    pub name: String,
    /// Its places.
    pub places: Vec<ClothPlace>,
}

/// A point of the cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClothPlace {
    /// In the flat pattern, mm.
    pub flat: [f64; 2],
    /// In space, mm.
    pub space: [f64; 3],
    /// How far it lies beyond the panel's mesh, mm.
    pub beyond: f64,
}

impl GoldenSurface {
    /// Places of a garment, chosen by its panels' shapes alone.
    pub(super) fn of(garment: &Garment) -> Self {
        let whole: f64 = garment.panels.iter().map(|p| garment.panel_areas(p).0).sum();
        let places = |panel: &GarmentPanel| {
            let share = garment.panel_areas(panel).0 / whole;
            let count = ((PLACES * share).round() as usize).max(LEAST);
            PanelPlaces { name: panel.name.clone(), places: chosen(garment, panel, count) }
        };
        Self::with(garment.panels.iter().map(places).collect())
    }

    /// The same places in another garment; those that it does not have are left out.
    pub(super) fn again(&self, garment: &Garment) -> Self {
        let places = |panel: &GarmentPanel| {
            let known = self.panels.iter().find(|p| p.name == panel.name);
            let lookup = Lookup::new(garment, panel);
            let find = |place: &ClothPlace| lookup.as_ref()?.find(place.flat);
            let places = known.iter().flat_map(|p| &p.places).filter_map(find).collect();
            PanelPlaces { name: panel.name.clone(), places }
        };
        Self::with(garment.panels.iter().map(places).collect())
    }

    fn with(panels: Vec<PanelPlaces>) -> Self {
        GoldenSurface { here: HERE, elsewhere: ELSEWHERE, panels }
    }

    /// How many places there are.
    pub(super) fn count(&self) -> usize {
        self.panels.iter().map(|p| p.places.len()).sum()
    }

    /// Why another surface differs, by the tolerance of this one for such arithmetic; `None` within
    /// it.
    pub(super) fn apart(&self, now: &GoldenSurface, arithmetic: Arithmetic) -> Option<String> {
        if let Some(new) = now.panels.iter().find(|p| !self.panels.iter().any(|q| q.name == p.name)) {
            return Some(format!("its panel \"{}\" is not in the golden sheet", new.name));
        }
        let mut moved: Vec<(f64, &str, ClothPlace, ClothPlace)> = Vec::new();
        for old in &self.panels {
            let Some(new) = now.panels.iter().find(|p| p.name == old.name) else {
                return Some(format!("it has no panel \"{}\" any more", old.name));
            };
            let same = |was: &ClothPlace| new.places.iter().find(|is| is.flat == was.flat).copied();
            let found: Vec<Option<ClothPlace>> = old.places.iter().map(same).collect();
            let lost = found.iter().filter(|f| f.is_none()).count();
            if lost > 0 {
                let of = old.places.len();
                return Some(format!(
                    "{lost} of the {of} places of panel \"{}\" are not on it any more",
                    old.name
                ));
            }
            let pairs = old.places.iter().zip(found.into_iter().flatten());
            moved.extend(pairs.map(|(was, is)| (far(was, &is), old.name.as_str(), *was, is)));
        }
        told(moved, if arithmetic == Arithmetic::Other { self.elsewhere } else { self.here })
    }
}

/// What is said of places that moved.
fn told(mut moved: Vec<(f64, &str, ClothPlace, ClothPlace)>, tolerance: PlaceTolerance) -> Option<String> {
    moved.sort_by(|a, b| a.0.total_cmp(&b.0));
    let distances: Vec<f64> = moved.iter().map(|m| m.0).collect();
    let p95 = quantile(&distances, 0.95);
    let (most, panel, was, is) = moved.last()?;
    let near = p95 <= tolerance.within_mm + SHEET_ROUNDING && *most <= tolerance.most_mm + SHEET_ROUNDING;
    if near {
        return None;
    }
    let PlaceTolerance { within_mm, most_mm } = tolerance;
    let at = |[x, y, z]: [f64; 3]| format!("({x:.1}, {y:.1}, {z:.1}) mm");
    let ([u, v], before, now) = (was.flat, at(was.space), at(is.space));
    Some(format!(
        "its surface moved by {p95:.2} mm at 95 % (tolerance {within_mm}) and by {most:.2} mm at most (tolerance {most_mm}): \
         panel \"{panel}\" at ({u:.0}, {v:.0}) mm was at {before}, is at {now}"
    ))
}

/// How far a point moved; one beyond the mesh is as far as its nearest point and the way there.
fn far(was: &ClothPlace, is: &ClothPlace) -> f64 {
    let square: f64 = was.space.iter().zip(is.space).map(|(a, b)| (a - b).powi(2)).sum();
    square.sqrt() + is.beyond
}

/// Finds places of a panel.
struct Lookup<'a> {
    garment: &'a Garment,
    triangles: &'a [[u32; 3]],
    locator: Locator,
}

impl<'a> Lookup<'a> {
    /// None for a panel without area.
    fn new(garment: &'a Garment, panel: &GarmentPanel) -> Option<Self> {
        let triangles = garment.triangles.get(panel.triangles.clone())?;
        let flat = triangles.iter().map(|t| t.map(|v| garment.rest[v as usize])).collect();
        Some(Lookup { garment, triangles, locator: Locator::new(flat, REACH)? })
    }

    fn find(&self, flat: [f64; 2]) -> Option<ClothPlace> {
        let found: Located = self.locator.find(Point2::from(flat.map(|c| c * 1e-3)))?;
        let corners = self.triangles[found.triangle].map(|v| self.garment.positions[v as usize]);
        let at = found.in_space(corners);
        Some(ClothPlace { flat, space: [at.x, at.y, at.z].map(|c| c * 1e3), beyond: found.beyond * 1e3 })
    }
}

/// The first places of the sequence that lie on the panel.
fn chosen(garment: &Garment, panel: &GarmentPanel, count: usize) -> Vec<ClothPlace> {
    let Some(lookup) = Lookup::new(garment, panel) else { return Vec::new() };
    let flat = &garment.rest[panel.vertices.clone()];
    let Some(first) = flat.first() else { return Vec::new() };
    let (lo, hi) = flat.iter().fold((*first, *first), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
    let on_grain = |c: f64| (c / GRAIN).round() / 10.0;
    let candidate = |i: usize| {
        let share = STEP.map(|s| (0.5 + s * i as f64).fract());
        [lo.x + share[0] * (hi.x - lo.x), lo.y + share[1] * (hi.y - lo.y)].map(on_grain)
    };
    let inside = |flat: [f64; 2]| lookup.find(flat).filter(|p| p.beyond == 0.0);
    (0..TRIES * count).map(candidate).filter_map(inside).take(count).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use toile_core::artifact::Point3;
    use toile_core::testkit::dress;

    fn apart(was: &GoldenSurface, is: &GoldenSurface) -> Option<String> {
        was.apart(is, Arithmetic::Same)
    }

    #[test]
    fn places_are_spread_over_every_panel_and_lie_where_the_cloth_does() {
        let garment = dress::garment();
        let surface = GoldenSurface::of(&garment);
        assert_eq!(surface.panels.iter().map(|p| p.places.len()).collect::<Vec<_>>(), [120, 120]);
        // The front lies in the plane z = 150 mm, 980 mm above the floor.
        for place in &surface.panels[0].places {
            let [u, v] = place.flat;
            let [x, y, z] = place.space;
            assert!((x - u).abs() < 1e-9 && (y - 980.0 - v).abs() < 1e-9 && (z - 150.0).abs() < 1e-9);
        }
        let quarters: std::collections::BTreeSet<_> =
            surface.panels[0].places.iter().map(|p| (p.flat[0] > 0.0, p.flat[1] > 250.0)).collect();
        assert_eq!(quarters.len(), 4);
    }

    #[test]
    fn another_mesh_of_the_same_cloth_lies_in_the_same_places() {
        let garment = dress::garment();
        let mut finer = garment.clone();
        // Each triangle cut in three at its middle.
        for t in garment.triangles[garment.panels[1].triangles.clone()].iter().copied() {
            let middle = finer.positions.len() as u32;
            let mean = |p: [Point3; 3]| Point3::from((p[0].coords + p[1].coords + p[2].coords) / 3.0);
            finer.positions.push(mean(t.map(|v| garment.positions[v as usize])));
            let flat: Point2 = Point2::from(
                t.map(|v| garment.rest[v as usize].coords).iter().sum::<toile_core::artifact::Vector2>()
                    / 3.0,
            );
            finer.rest.push(flat);
            finer.panels[1].vertices.end += 1;
            for k in 0..3 {
                finer.triangles.push([t[k], t[(k + 1) % 3], middle]);
            }
        }
        let start = garment.panels[1].triangles.start;
        finer.triangles.drain(garment.panels[1].triangles.clone());
        finer.panels[1].triangles = start..finer.triangles.len();
        let was = GoldenSurface::of(&garment);
        assert_eq!(apart(&was, &was.again(&finer)), None);
    }

    #[test]
    fn a_surface_that_moved_is_told_with_its_figure_and_its_place() {
        let was = GoldenSurface::of(&dress::garment());
        let moved = |by: f64, of: &str| {
            let mut garment = dress::garment();
            let panel = garment.panels.iter().find(|p| p.name == of).unwrap().vertices.clone();
            garment.positions[panel].iter_mut().for_each(|p| p.z += by * 1e-3);
            apart(&was, &was.again(&garment))
        };
        assert_eq!(moved(0.19, "front"), None);
        let told = moved(0.3, "front").unwrap();
        let start = "its surface moved by 0.30 mm at 95 % (tolerance 0.2) and by 0.30 mm at most (tolerance 1): panel \"front\" at (";
        assert!(told.starts_with(start) && told.contains(", 150.0) mm, is at ("), "{told}");
    }

    #[test]
    fn another_machine_has_more_room_and_not_all_of_it() {
        let was = GoldenSurface::of(&dress::garment());
        let moved = |by: f64| {
            let mut garment = dress::garment();
            garment.positions.iter_mut().for_each(|p| p.z += by * 1e-3);
            was.apart(&was.again(&garment), Arithmetic::Other)
        };
        assert_eq!(moved(2.9), None);
        assert!(moved(3.1).is_some_and(|told| told.contains("3.10 mm at 95 % (tolerance 3)")));
    }

    #[test]
    fn a_fold_that_few_places_see_is_a_difference_as_well() {
        let was = GoldenSurface::of(&dress::garment());
        let mut garment = dress::garment();
        // A corner of the front, by 5 cm: fewer than 5 % of the places.
        let corner =
            garment.rest.iter().take(garment.panels[0].vertices.end).position(|q| q.x > 0.26 && q.y < 0.01);
        garment.positions[corner.unwrap()].z += 0.05;
        let told = apart(&was, &was.again(&garment)).unwrap();
        assert!(told.starts_with("its surface moved by 0.00 mm at 95 % "), "{told}");
    }

    #[test]
    fn panels_that_come_or_go_and_places_that_are_lost_are_told() {
        let was = GoldenSurface::of(&dress::garment());
        let mut renamed = dress::garment();
        renamed.panels[1].name = "rear".into();
        assert_eq!(
            apart(&was, &was.again(&renamed)).unwrap(),
            "its panel \"rear\" is not in the golden sheet"
        );
        let mut shorter = was.clone();
        shorter.panels.pop();
        assert_eq!(apart(&was, &shorter).unwrap(), "it has no panel \"back\" any more");
        let mut narrow = dress::garment();
        narrow.rest.iter_mut().for_each(|q| q.x *= 0.8);
        let told = apart(&was, &was.again(&narrow)).unwrap();
        assert!(told.ends_with(" of the 120 places of panel \"front\" are not on it any more"), "{told}");
    }
}

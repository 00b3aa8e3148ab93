//! Which stage feeds which.

use super::*;

#[test]
fn stages_follow_each_other_by_type_and_sections_stand_as_early_as_they_can() {
    let expected = [
        "Photos",
        "Mannequin",
        "Preset",
        "Mean < Photos",
        "Otsu < Mean",
        "Canny < Mean, Otsu",
        "Vest < Canny",
        "Seams < Vest, Vest.1",
        "GridMesher < Seams",
        "Taubin < GridMesher",
        "Painter < Taubin, Photos, Mannequin, Preset",
        "Glb < Painter",
        "Report < log",
    ];
    assert_eq!(wiring(&good(kit::VEST)), expected);
}

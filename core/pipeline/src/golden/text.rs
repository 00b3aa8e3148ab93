//! A sheet as text and back.

use super::surface::{ClothPlace, GoldenSurface, PanelPlaces, PlaceTolerance};
use super::{GoldenSheet, MadeBy, SheetMeasure, SheetSection};
use std::fmt::Write;

/// A line of a sheet that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct SheetError {
    /// Its number, from 1.
    pub line: usize,
    /// What is wrong.
    pub message: String,
}

/// The widest tolerance of a measure, as far as its value is smaller: one that is wider than both
/// sees nothing.
const MOST_TOLERANCE: f64 = 100.0;
/// The widest tolerances of a surface, at 95 % and at most, mm: a drape's claims are of a few
/// millimetres.
const MOST_SURFACE_MM: [f64; 2] = [10.0, 30.0];
/// The most places of one surface.
const MOST_PLACES: usize = 10_000;

const STAGE_FORM: &str = "a stage is `stage ID = NAME VERSION (PARAMETERS)`";
const FORM: &str = "a measure is `NAME = VALUE UNIT +- TOLERANCE`";
const SURFACE_FORM: &str = "a surface is `surface = COUNT places +- TOLERANCE; elsewhere TOLERANCE`, a tolerance `0.2 mm at 95 %, 1 mm at most`";
const PLACE_FORM: &str = "a place is five numbers: two in the pattern, three in space, mm";

impl std::fmt::Display for GoldenSheet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if !self.arithmetic.is_empty() {
            writeln!(f, "arithmetic = {}", self.arithmetic)?;
        }
        for stage in &self.stages {
            writeln!(f, "stage {} = {}", stage.id, stage.value())?;
        }
        if !self.arithmetic.is_empty() || !self.stages.is_empty() {
            writeln!(f)?;
        }
        for section in &self.sections {
            writeln!(f, "[{}]", section.title())?;
            for m in &section.measures {
                writeln!(f, "{} = {}", m.name, value_text(m))?;
            }
            if let Some(surface) = &section.surface {
                write_surface(f, surface)?;
            }
            if !section.digest.is_empty() {
                writeln!(f, "digest = {}", section.digest)?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

fn write_surface(f: &mut std::fmt::Formatter<'_>, surface: &GoldenSurface) -> std::fmt::Result {
    let words =
        |t: PlaceTolerance| format!("{} mm at 95 %, {} mm at most", tidy(t.within_mm), tidy(t.most_mm));
    let (here, elsewhere) = (words(surface.here), words(surface.elsewhere));
    writeln!(f, "surface = {} places +- {here}; elsewhere {elsewhere}", surface.count())?;
    for panel in &surface.panels {
        writeln!(f, "panel {}", panel.name)?;
        for ClothPlace { flat: [u, v], space, .. } in &panel.places {
            let [x, y, z] = space.map(hundredths);
            writeln!(f, "{u} {v} {x} {y} {z}")?;
        }
    }
    Ok(())
}

fn value_text(m: &SheetMeasure) -> String {
    let mut s = tidy(m.value);
    if !m.unit.is_empty() {
        let _ = write!(s, " {}", m.unit);
    }
    let _ = write!(s, " +- {}", tidy(m.tolerance));
    s
}

/// Six significant decimals are finer than any tolerance, and keep the sheet readable.
fn tidy(x: f64) -> String {
    short(format!("{x:.6}"))
}

fn hundredths(x: f64) -> String {
    short(format!("{x:.2}"))
}

fn short(text: String) -> String {
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Reads a sheet.
///
/// Errors: the first line that is neither a heading, a measure, a surface, a place of it, a digest,
/// empty nor a comment; a value that is no finite number; a tolerance that is negative or so wide
/// that nothing would be seen; what is given twice.
pub fn parse(text: &str) -> Result<GoldenSheet, SheetError> {
    let mut reader = SheetReader::default();
    let mut last = 1;
    for (i, line) in text.lines().enumerate() {
        last = i + 1;
        reader.line(line.trim()).map_err(|message| SheetError { line: last, message })?;
    }
    reader.whole().map_err(|message| SheetError { line: last, message })?;
    Ok(reader.sheet)
}

/// A sheet on its way.
#[derive(Default)]
struct SheetReader {
    sheet: GoldenSheet,
    /// Places that the surface at work announced.
    announced: Option<usize>,
}

impl SheetReader {
    fn line(&mut self, line: &str) -> Result<(), String> {
        if line.is_empty() || line.starts_with('#') {
            return Ok(());
        }
        if let Some(title) = line.strip_prefix('[') {
            return self.heading(title.strip_suffix(']').ok_or("a heading ends with `]`")?);
        }
        if let (Some(name), true) = (line.strip_prefix("panel "), self.announced.is_some()) {
            return self.panel(name);
        }
        let Some((name, value)) = line.split_once(" = ") else {
            return if self.announced.is_some() { self.place(line) } else { Err(FORM.into()) };
        };
        match (name, self.sheet.sections.is_empty()) {
            ("arithmetic", true) if self.sheet.arithmetic.is_empty() => {
                value.clone_into(&mut self.sheet.arithmetic);
                Ok(())
            }
            ("arithmetic", true) => Err("`arithmetic` is given twice".into()),
            (name, true) if name.starts_with("stage ") => self.made_by(&name["stage ".len()..], value),
            (_, true) => Err("a measure stands before the first heading".into()),
            ("digest", _) => self.digest(value),
            ("surface", _) => self.surface(value),
            _ => self.measure(name, value),
        }
    }

    fn made_by(&mut self, id: &str, value: &str) -> Result<(), String> {
        let stage = MadeBy::parsed(id, value).ok_or(STAGE_FORM)?;
        if self.sheet.stages.iter().any(|s| s.id == id) {
            return Err(format!("the stage `{id}` is given twice"));
        }
        self.sheet.stages.push(stage);
        Ok(())
    }

    fn heading(&mut self, title: &str) -> Result<(), String> {
        self.whole()?;
        let section = heading(title).ok_or("a heading is `[STAGE KIND NAME]`")?;
        if self.sheet.sections.iter().any(|s| s.title() == section.title()) {
            return Err(format!("the section `[{}]` is given twice", section.title()));
        }
        self.sheet.sections.push(section);
        Ok(())
    }

    /// The section at work.
    fn section(&mut self) -> Result<&mut SheetSection, String> {
        self.sheet.sections.last_mut().ok_or_else(|| "a measure stands before the first heading".to_owned())
    }

    fn digest(&mut self, value: &str) -> Result<(), String> {
        self.whole()?;
        let section = self.section()?;
        if !section.digest.is_empty() {
            return Err("`digest` is given twice".into());
        }
        value.clone_into(&mut section.digest);
        Ok(())
    }

    fn measure(&mut self, name: &str, value: &str) -> Result<(), String> {
        self.whole()?;
        let measure = measure(name, value)?;
        let section = self.section()?;
        if section.measures.iter().any(|m| m.name == name) {
            return Err(format!("`{name}` is given twice"));
        }
        section.measures.push(measure);
        Ok(())
    }

    fn surface(&mut self, value: &str) -> Result<(), String> {
        let (surface, count) = surface(value)?;
        let section = self.section()?;
        if section.surface.is_some() {
            return Err("`surface` is given twice".into());
        }
        section.surface = Some(surface);
        self.announced = Some(count);
        Ok(())
    }

    fn panel(&mut self, name: &str) -> Result<(), String> {
        let panels = self.section()?.surface.as_mut().map(|s| &mut s.panels).ok_or(FORM)?;
        if panels.iter().any(|p| p.name == name) {
            return Err(format!("the panel \"{name}\" is given twice"));
        }
        panels.push(PanelPlaces { name: name.to_owned(), places: Vec::new() });
        Ok(())
    }

    fn place(&mut self, line: &str) -> Result<(), String> {
        let numbers: Option<Vec<f64>> = line.split_whitespace().map(finite).collect();
        let [u, v, x, y, z] = numbers.as_deref().unwrap_or_default() else { return Err(PLACE_FORM.into()) };
        let surface = self.section()?.surface.as_mut();
        let panel = surface.and_then(|s| s.panels.last_mut());
        let panel = panel.ok_or("a place stands before the first `panel NAME`")?;
        panel.places.push(ClothPlace { flat: [*u, *v], space: [*x, *y, *z], beyond: 0.0 });
        Ok(())
    }

    /// Ends the surface at work: a sheet that lost places does not see what it saw.
    fn whole(&mut self) -> Result<(), String> {
        let Some(announced) = self.announced.take() else { return Ok(()) };
        let found = self.section()?.surface.as_ref().map_or(0, GoldenSurface::count);
        match found == announced {
            true => Ok(()),
            false => Err(format!("the surface above announces {announced} places and has {found}")),
        }
    }
}

fn heading(title: &str) -> Option<SheetSection> {
    let mut words = title.splitn(3, ' ');
    let mut word = || words.next().filter(|word| !word.is_empty());
    let (stage, kind) = (word()?.to_owned(), word()?.replace('_', " "));
    let entry = words.next().unwrap_or("").to_owned();
    Some(SheetSection { stage, kind, entry, measures: Vec::new(), surface: None, digest: String::new() })
}

fn measure(name: &str, text: &str) -> Result<SheetMeasure, String> {
    let (value, tolerance) = text.split_once(" +- ").ok_or(FORM)?;
    let (number, unit) = value.split_once(' ').unwrap_or((value, ""));
    number.parse::<f64>().map_err(|_| FORM)?;
    let value = finite(number).ok_or_else(|| format!("`{name}`: the value {number} is no finite number"))?;
    let most = value.abs().max(MOST_TOLERANCE);
    let tolerance = tolerated(name, tolerance.trim(), most, FORM)?;
    Ok(SheetMeasure { name: name.to_owned(), value, unit: unit.to_owned(), tolerance })
}

fn surface(text: &str) -> Result<(GoldenSurface, usize), String> {
    let form = || SURFACE_FORM.to_owned();
    let (count, rest) = text.split_once(" places +- ").ok_or_else(form)?;
    let (here, elsewhere) = rest.split_once("; elsewhere ").ok_or_else(form)?;
    let count: usize = count.parse().map_err(|_| form())?;
    if count > MOST_PLACES {
        return Err(format!("a surface of {count} places, the limit is {MOST_PLACES}"));
    }
    let read = |text: &str| {
        let (within, most) = text.split_once(" mm at 95 %, ").ok_or_else(form)?;
        let most = most.strip_suffix(" mm at most").ok_or_else(form)?;
        let [widest, farthest] = MOST_SURFACE_MM;
        let within_mm = tolerated("surface", within, widest, SURFACE_FORM)?;
        Ok::<_, String>(PlaceTolerance {
            within_mm,
            most_mm: tolerated("surface", most, farthest, SURFACE_FORM)?,
        })
    };
    Ok((GoldenSurface { here: read(here)?, elsewhere: read(elsewhere)?, panels: Vec::new() }, count))
}

/// A tolerance from 0 to `most`.
fn tolerated(name: &str, text: &str, most: f64, form: &str) -> Result<f64, String> {
    let tolerance: f64 = text.parse().map_err(|_| form.to_owned())?;
    let is_wide = tolerance > most;
    match tolerance {
        t if t.is_nan() => Err(format!("`{name}`: the tolerance {text} is no number")),
        t if t < 0.0 => Err(format!("`{name}`: the tolerance {text} is negative, so nothing would agree")),
        _ if is_wide => Err(format!(
            "`{name}`: the tolerance {text} is so wide that nothing would be seen; the widest here is {}",
            tidy(most)
        )),
        t => Ok(t),
    }
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|x: &f64| x.is_finite())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    const EXAMPLE: &str = "arithmetic = 8d77\nstage GridMesher = GridMesher 2 (edge:\"16 mm\", k:1)\n\n[GridMesher panel front]\narea = 2412.31 cm2 +- 1\nboundary_loops = 1 +- 0\ndigest = 5f2a\n\n\
                           [Place garment]\nvertices = 2 +- 0.02\nsurface = 3 places +- 0.2 mm at 95 %, 1 mm at most; elsewhere 3 mm at 95 %, 20 mm at most\n\
                           panel front\n-12.3 45.6 -20.11 1204.5 133.87\n1 2 3 4 5\npanel a = b\n0 0 0 0 0\ndigest = 00ff\n\n";

    fn refused(text: &str) -> String {
        parse(text).unwrap_err().to_string()
    }

    #[test]
    fn a_heading_names_a_stage_and_a_kind() {
        for heading in ["[ ]", "[]", "[Otsu]", "[Otsu ]", "[ mask]"] {
            assert_eq!(refused(heading), "line 1: a heading is `[STAGE KIND NAME]`", "{heading}");
        }
        assert_eq!(parse("[Otsu mask]").unwrap().sections[0].title(), "Otsu mask");
    }

    #[test]
    fn a_sheet_reads_back_as_it_was_written() {
        assert_eq!(parse(EXAMPLE).unwrap().to_string(), EXAMPLE);
    }

    #[test]
    fn a_fault_names_its_line() {
        assert_eq!(refused("[A panel]\narea 12"), "line 2: a measure is `NAME = VALUE UNIT +- TOLERANCE`");
        assert_eq!(refused("area = 1 +- 0"), "line 1: a measure stands before the first heading");
        let stage = "line 1: a stage is `stage ID = NAME VERSION (PARAMETERS)`";
        assert_eq!(refused("stage A = A one ()"), stage);
    }

    #[test]
    fn a_tolerance_that_sees_nothing_is_refused() {
        let with = |tolerance: &str| refused(&format!("[A panel]\n\narea = 250 cm2 +- {tolerance}\n"));
        let wide = |t: &str, most: &str| {
            format!(
                "line 3: `area`: the tolerance {t} is so wide that nothing would be seen; the widest here is {most}"
            )
        };
        for t in ["inf", "1e308", "1e9", "250.1", "+infinity"] {
            assert_eq!(with(t), wide(t, "250"));
        }
        for t in ["-1", "-1e-300", "-inf"] {
            assert_eq!(
                with(t),
                format!("line 3: `area`: the tolerance {t} is negative, so nothing would agree")
            );
        }
        assert_eq!(with("NaN"), "line 3: `area`: the tolerance NaN is no number");
        assert_eq!(with("x"), "line 3: a measure is `NAME = VALUE UNIT +- TOLERANCE`");
        assert!(parse("[A panel]\nseam_gap_max = 0 mm +- 100\n").is_ok());
        assert_eq!(
            refused("[A panel]\nseam_gap_max = 0 mm +- 100.5\n"),
            "line 2: `seam_gap_max`: the tolerance 100.5 is so wide that nothing would be seen; the widest here is 100"
        );
        let surface = |t: &str| refused(&EXAMPLE.replace("+- 0.2 mm", &format!("+- {t} mm")));
        assert!(
            surface("11").starts_with("line 11: `surface`: the tolerance 11 is so wide "),
            "{}",
            surface("11")
        );
        assert!(surface("-0.1").starts_with("line 11: `surface`: the tolerance -0.1 is negative"));
        assert!(surface("nan").starts_with("line 11: `surface`: the tolerance nan is no number"));
    }

    #[test]
    fn a_value_that_is_no_number_is_refused() {
        assert_eq!(
            refused("[A panel]\narea = inf cm2 +- 1"),
            "line 2: `area`: the value inf is no finite number"
        );
        assert_eq!(
            refused("[A panel]\narea = NaN +- 1"),
            "line 2: `area`: the value NaN is no finite number"
        );
    }

    #[test]
    fn what_is_given_twice_is_refused() {
        assert_eq!(refused("[A panel]\n[A panel]"), "line 2: the section `[A panel]` is given twice");
        assert_eq!(refused("[A panel]\na = 1 +- 0\na = 1 +- 0"), "line 3: `a` is given twice");
        assert_eq!(refused("[A panel]\ndigest = a\ndigest = b"), "line 3: `digest` is given twice");
        assert_eq!(refused("arithmetic = a\narithmetic = b"), "line 2: `arithmetic` is given twice");
        assert_eq!(refused("stage A = A 1 ()\nstage A = B 1 ()"), "line 2: the stage `A` is given twice");
    }

    #[test]
    fn a_sheet_that_lost_places_is_refused() {
        let lost = EXAMPLE.replace("1 2 3 4 5\n", "");
        assert_eq!(refused(&lost), "line 16: the surface above announces 3 places and has 2");
        let cut = EXAMPLE.split_inclusive("133.87\n").next().unwrap();
        assert_eq!(refused(cut), "line 13: the surface above announces 3 places and has 1");
        let half = EXAMPLE.replace("1 2 3 4 5\n", "1 2 3 4\n");
        assert_eq!(
            refused(&half),
            "line 14: a place is five numbers: two in the pattern, three in space, mm"
        );
        assert_eq!(refused(&EXAMPLE.replace("1 2 3 4 5\n", "1 2 3 4 inf\n")), refused(&half));
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in "[\\[\\]a-z0-9 =+\\-.\n#%,]{0,200}") {
            let _ = parse(&text);
        }

        #[test]
        fn a_sheet_with_a_changed_line_is_read_or_refused(line in 0usize..18, with in "[\\[\\]a-z0-9 =+\\-.]{0,40}") {
            let text: Vec<&str> = EXAMPLE.lines().enumerate().map(|(i, l)| if i == line { with.as_str() } else { l }).collect();
            if let Ok(sheet) = parse(&text.join("\n")) {
                prop_assert!(parse(&sheet.to_string()).is_ok());
            }
        }
    }
}

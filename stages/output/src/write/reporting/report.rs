//! `Report`: one self-contained page on the run.
//!
//! Views of the result, key figures, then every stage with its pictures, parameters, time and
//! measures. Cost: two small drawings for every garment on the way. Limit: pictures beyond
//! `PICTURE_BUDGET` are left out, and the page says so.

use crate::write::reporting::data::{ReportPage, VIEW_HEIGHT, page};
use crate::write::reporting::views::{self, Views};
use minijinja::Environment;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Serde, Value};
use toile_core::Known;
use toile_core::decide::Decision;
use toile_core::prelude::*;

/// The name of the page's template: autoescaped, since it ends in `.html`.
const TEMPLATE_NAME: &str = "report.html";
/// The page's template.
const TEMPLATE: &str = include_str!("report.html");
/// What joins the turntable and the origins.
const SCRIPT: &str = include_str!("report.js");

/// Writes a page on the run: every stage with its pictures, parameters, time and numbers.
///
/// One file with no links to others; opens in any browser, light or dark.
///
/// Its times are those of the run that made the page: where all that it reports on comes from the
/// cache, so does the page, with the times of that earlier run.
#[stage(
    role = Writer,
    version = 3,
    source = "none",
    example = "Report(name: \"report\", pictures: 300)",
    contracts(Deterministic)
)]
pub struct Report {
    /// The file's name without its extension.
    #[param(default = "report".to_owned())]
    name: String,
    /// Height of the stages' pictures.
    #[param(default = 300, min = 32, max = 1200, unit = "px", trades)]
    pictures: u32,
    /// Where the views of the result at the head come from.
    #[param(default = Views::Taken, trades)]
    views: Views,
}

#[stage]
impl Report {
    pub(crate) fn run(&self, run: &RunLog, cx: &Context) -> Result<OutputFiles, StageError> {
        crate::file_names::check_name(&self.name)?;
        let page = page(run, self.pictures, self.views, cx)?;
        let html =
            html(&page).map_err(|e| StageError::internal(format!("the report's template fails: {e}")))?;
        Ok(OutputFiles::one(&format!("{}.html", self.name), html.into_bytes()))
    }

    fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        views::rule(known, self.views, VIEW_HEIGHT).into_iter().collect()
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        crate::file_names::check_name(&self.name).err().into_iter().collect()
    }
}

fn html(page: &ReportPage) -> Result<String, minijinja::Error> {
    let mut environment = Environment::new();
    environment.set_syntax(SyntaxConfig::builder().trim_blocks(true).build()?);
    environment.add_template(TEMPLATE_NAME, TEMPLATE)?;
    environment.add_global("script", SCRIPT);
    environment.get_template(TEMPLATE_NAME)?.render(Value::from(Serde(page)))
}

//! Arguments of `toile verify`.

use clap::Args;
use clap::builder::RangedU64ValueParser;
use std::path::PathBuf;
use toile_core::param::Length;
use toile_pipeline::Override;
use toile_verify::files::Up;

#[derive(Debug, Args)]
pub(crate) struct VerifyArgs {
    /// The output folder of a run, or a garment's .glb or .obj file of any program
    pub(crate) garment: PathBuf,
    /// The pattern that it was sewn from: GarmentCode's .json, a .dxf, .svg,
    /// .sm2d or .val file
    #[arg(long, value_name = "FILE")]
    pub(crate) pattern: Option<PathBuf>,
    /// The seams of a pattern, where a file of their own holds them; not of GarmentCode's
    #[arg(long, value_name = "FILE", requires = "pattern")]
    pub(crate) seams: Option<PathBuf>,
    /// A parameter of the pattern's reader, in the words of a pipeline, like 'pattern.size="M"',
    /// pattern.unit=Inches or 'pattern.measurements="me.smis"'; repeatable
    #[arg(long = "set", value_name = "PATH=VALUE", value_parser = <Override as std::str::FromStr>::from_str)]
    pub(crate) set: Vec<Override>,
    /// The body that wears it, a .obj or .glb file [default: that of the garment's file]
    #[arg(long, value_name = "FILE")]
    pub(crate) body: Option<PathBuf>,
    /// A second garment of the same pattern, to be judged and compared
    #[arg(long, value_name = "GARMENT")]
    pub(crate) compare: Option<PathBuf>,
    /// Length of one of the numbers of the garment's file, like "1 cm" [default: metres in a GLB;
    /// in an OBJ that in which it is as large as a garment]
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub(crate) unit: Option<Length>,
    /// The axis of the files that points up [default: y in a GLB; in an OBJ that along which a body
    /// is tall, or in which the garment stands]
    #[arg(long, value_name = "AXIS", value_parser = up)]
    pub(crate) up: Option<Up>,
    /// Greatest gap of a seam [default: 0.5 mm]
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub(crate) max_gap: Option<Length>,
    /// Greatest 99th percentile of the strain of a panel's edges that the body stretches, in
    /// percent
    #[arg(long, value_name = "PERCENT", default_value_t = 25, value_parser = RangedU64ValueParser::<u16>::new().range(1..=1000))]
    pub(crate) max_tight: u16,
    /// What the garment is made of, where its rest is to be judged: a name like "denim", or a
    /// fabric as a pipeline names it, like 'Kes(weight: 12)'
    #[arg(long, value_name = "FABRIC")]
    pub(crate) fabric: Option<String>,
    /// Friction of cloth on the body [default: 0.3]
    #[arg(long, value_name = "NUMBER", requires = "fabric")]
    pub(crate) friction: Option<f64>,
    /// The farthest that the garment may move when it is let go [default: 5 mm]
    #[arg(long, value_name = "LENGTH", value_parser = length, requires = "fabric")]
    pub(crate) max_shift: Option<Length>,
    /// The certificate's file [default: certificate.json beside the garment]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Print one JSON object, the certificate, and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

/// The axis that points up.
fn up(text: &str) -> Result<Up, String> {
    match text.to_ascii_lowercase().as_str() {
        "y" => Ok(Up::Y),
        "z" => Ok(Up::Z),
        _ => Err(format!("\"{text}\" is neither y nor z")),
    }
}

/// A length above 0.
fn length(text: &str) -> Result<Length, String> {
    let length: Length = text.parse()?;
    match length.metres() > 0.0 {
        true => Ok(length),
        false => Err(format!("\"{text}\" is not above 0")),
    }
}

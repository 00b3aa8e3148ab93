//! Arguments of `toile verify`.

use clap::Args;
use clap::builder::RangedU64ValueParser;
use std::path::PathBuf;
use toile_core::param::Length;

#[derive(Debug, Args)]
pub(crate) struct VerifyArgs {
    /// The output folder of a run, or a garment's .glb or .obj file of any program
    pub(crate) garment: PathBuf,
    /// The pattern that it was sewn from: GarmentCode's .json, a .dxf or an .svg file
    #[arg(long, value_name = "FILE")]
    pub(crate) pattern: Option<PathBuf>,
    /// The seams of a .dxf or .svg pattern, where a file of their own holds them
    #[arg(long, value_name = "FILE", requires = "pattern")]
    pub(crate) seams: Option<PathBuf>,
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
    /// Greatest gap of a seam [default: 0.5 mm]
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub(crate) max_gap: Option<Length>,
    /// Greatest 99th percentile of the strain of a panel's edges that the body stretches, in
    /// percent
    #[arg(long, value_name = "PERCENT", default_value_t = 25, value_parser = RangedU64ValueParser::<u16>::new().range(1..=1000))]
    pub(crate) max_tight: u16,
    /// The certificate's file [default: certificate.json beside the garment]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Print one JSON object, the certificate, and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

/// A length above 0.
fn length(text: &str) -> Result<Length, String> {
    let length: Length = text.parse()?;
    match length.metres() > 0.0 {
        true => Ok(length),
        false => Err(format!("\"{text}\" is not above 0")),
    }
}

//! The network: a photo in, a map of the salient object out.
//!
//! U2-Net and its small sibling U2-Net-p: nested U-shaped stacks of convolutions, trained on
//! pictures of single objects (Qin, Zhang, Huang, Dehghan, Zaiane, Jagersand, U2-Net: going deeper
//! with nested U-structure for salient object detection, Pattern Recognition 106, 2020). The photo
//! is brought to 320 x 320 pixels, whatever its shape, as it was in training; of the seven maps
//! that come out the first is the answer.
//!
//! A convolution sums in the same order for any number of threads (tests/weights.rs holds the
//! bits). Processors with vectors of another width may differ in the last bits.
//!
//! Cost: 0.5 to 0.7 s and 80 MB for U2-Net-p with AVX-512; a second thread saves a twentieth.
//! Limits: whatever is no object of its own to the eye (a dark sleeve on dark wood) is left out. A
//! file may ask for any amount of memory: its digest is compared with the pipeline's before it
//! comes here.

use crate::fault::Unfit;
use image::RgbImage;
use image::imageops::{FilterType, resize};
use rten::{
    Dimension, LoadErrorKind, Model, ModelOptions, NodeId, RunOptions, ThreadPool, TryFromValueError, Value,
    ValueView,
};
use std::sync::Arc;
use toile_core::panics::caught;

/// Width and height of the photo that the network takes, and of the map that it gives, px.
pub const SIDE: usize = 320;
/// What the network takes: photos, channels, rows, columns.
const TAKES: [usize; 4] = [1, 3, SIDE, SIDE];
/// What the network gives.
const GIVES: [usize; 4] = [1, 1, SIDE, SIDE];
/// Mean and standard deviation of the channels in training, shares of full light.
const MEAN: [f32; 3] = [0.485, 0.456, 0.406];
const SPREAD: [f32; 3] = [0.229, 0.224, 0.225];
/// The longest message of the runtime that is repeated, characters.
const MAX_WORDS: usize = 200;

/// How sure the network is that a pixel belongs to the object, 0 to 1, row by row, [`SIDE`] x
/// [`SIDE`].
#[derive(Debug, Clone, PartialEq)]
pub struct Map(Vec<f32>);

impl Map {
    /// The map of those values; none where they are not [`SIDE`] x [`SIDE`] finite numbers.
    pub fn of(values: Vec<f32>) -> Option<Map> {
        (values.len() == SIDE * SIDE && values.iter().all(|v| v.is_finite())).then_some(Map(values))
    }

    /// The values, row by row.
    pub fn values(&self) -> &[f32] {
        &self.0
    }
}

/// A photo as the network takes it: [`SIDE`] x [`SIDE`] pixels, whatever its shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Guide(RgbImage);

impl Guide {
    /// The photo brought to that size; black where it has no pixels.
    pub fn of(photo: &RgbImage) -> Guide {
        let side = SIDE as u32;
        Guide(match photo.is_empty() {
            true => RgbImage::new(side, side),
            false => resize(photo, side, side, FilterType::Triangle),
        })
    }

    /// The pixels.
    pub fn pixels(&self) -> &RgbImage {
        &self.0
    }
}

/// A network that is ready to be run.
#[derive(Debug)]
pub struct Network {
    model: Model,
    input: NodeId,
    output: NodeId,
}

impl Network {
    /// The network of an ONNX file.
    ///
    /// # Errors
    /// The file is no ONNX file, is damaged, uses operators that U2-Net does not use, or takes or
    /// gives other shapes.
    pub fn load(file: Vec<u8>) -> Result<Network, Unfit> {
        let model = caught(|| options().load(file)).map_err(|said| Unfit::Broken(short(&said)))?;
        let model = model.map_err(|e| match e.kind() {
            LoadErrorKind::UnknownFileType | LoadErrorKind::FormatNotEnabled => Unfit::NoOnnx,
            LoadErrorKind::ParseError => Unfit::Damaged,
            _ => Unfit::Unreadable(short(&e.to_string())),
        })?;
        let input = one_input(&model)?;
        let output = first_output(&model)?;
        Ok(Network { model, input, output })
    }

    /// What it sees in a photo, on so many threads.
    ///
    /// # Errors
    /// It breaks off, gives another shape, or values that are not finite.
    pub fn map(&self, guide: &Guide, threads: usize) -> Result<Map, Unfit> {
        let made =
            caught(|| self.run(&levels(&guide.0), threads)).map_err(|said| Unfit::Broken(short(&said)))??;
        match made.into_shape_vec::<f32, 4>() {
            Ok((GIVES, values)) => Map::of(values).ok_or(Unfit::NoNumbers),
            Ok((shape, _)) => Err(gives(words(&shape))),
            Err(TryFromValueError::WrongRank { actual, .. }) => Err(gives(format!("{actual} dimensions"))),
            Err(_) => Err(gives("values of another type".into())),
        }
    }

    fn run(&self, levels: &[f32], threads: usize) -> Result<Value, Unfit> {
        let broken = |said: String| Unfit::Broken(short(&said));
        let photo = ValueView::from_shape(TAKES, levels).map_err(|e| broken(e.to_string()))?;
        let pool = Arc::new(ThreadPool::with_num_threads(threads));
        let options = RunOptions::default().with_thread_pool(Some(pool));
        let made = self.model.run_n(vec![(self.input, photo.into())], [self.output], Some(options));
        made.map(|[map]| map).map_err(|e| broken(e.to_string()))
    }
}

/// The operators that the network is made of. There is no loop among them, so that every run ends.
fn options() -> ModelOptions {
    ModelOptions::with_ops(rten::op_registry!(
        Add, Cast, Concat, Conv, Gather, MaxPool, Relu, Resize, Shape, Sigmoid, Slice, Unsqueeze
    ))
}

/// The only input, where it is a photo.
fn one_input(model: &Model) -> Result<NodeId, Unfit> {
    let takes = |found| Err(Unfit::Takes { found, wanted: words(&TAKES) });
    let &[input] = model.input_ids() else {
        return takes(format!("{} inputs", model.input_ids().len()));
    };
    match model.node_info(input).and_then(|info| info.shape()) {
        Some(shape) if !fits(&shape, &TAKES) => takes(dimensions(&shape)),
        _ => Ok(input),
    }
}

/// The first output, where it is a map.
fn first_output(model: &Model) -> Result<NodeId, Unfit> {
    let &output = model.output_ids().first().ok_or_else(|| gives("nothing".into()))?;
    match model.node_info(output).and_then(|info| info.shape()) {
        Some(shape) if !fits(&shape, &GIVES) => Err(gives(dimensions(&shape))),
        _ => Ok(output),
    }
}

fn gives(found: String) -> Unfit {
    Unfit::Gives { found, wanted: words(&GIVES) }
}

/// Whether a stated shape can be the wanted one; what it leaves open is seen when it is run.
fn fits(stated: &[Dimension], wanted: &[usize]) -> bool {
    let fit = |(stated, wanted): (&Dimension, &usize)| match stated {
        Dimension::Fixed(n) => n == wanted,
        Dimension::Symbolic(_) => true,
    };
    stated.len() == wanted.len() && stated.iter().zip(wanted).all(fit)
}

fn dimensions(shape: &[Dimension]) -> String {
    let word = |d: &Dimension| match d {
        Dimension::Fixed(n) => n.to_string(),
        Dimension::Symbolic(_) => "?".to_owned(),
    };
    product(shape.iter().map(word).collect())
}

fn words(shape: &[usize]) -> String {
    product(shape.iter().map(usize::to_string).collect())
}

fn product(sides: Vec<String>) -> String {
    if sides.is_empty() { "a single number".into() } else { sides.join(" x ") }
}

/// The first sentence of a message, on one line; names out of a file may hold anything.
fn short(said: &str) -> String {
    let first = said.split(". ").next().unwrap_or_default();
    first.chars().map(|c| if c.is_control() { ' ' } else { c }).take(MAX_WORDS).collect()
}

/// The pixels as the network was trained on them: shares of the lightest level, then by mean and
/// spread, channel by channel.
fn levels(guide: &RgbImage) -> Vec<f32> {
    let lightest = f32::from(guide.as_raw().iter().copied().max().unwrap_or(0).max(1));
    let level = |c: usize, v: u8| (f32::from(v) / lightest - MEAN[c]) / SPREAD[c];
    (0..3).flat_map(|c| guide.pixels().map(move |p| level(c, p.0[c]))).collect()
}

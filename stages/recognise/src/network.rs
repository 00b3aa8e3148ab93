//! The network: a photo in the square in, six lists of values out.
//!
//! A convolutional network of our own: an encoder of residual blocks (He, Zhang, Ren, Sun 2016), a
//! decoder with skips to a quarter of the resolution (Lin, Dollár, Girshick, He, Hariharan,
//! Belongie 2017), and heads for parts, landmarks, kind, limbs and flags. Which one it is, its file
//! says; here stands what is common to all: names and shapes of what goes in and out.
//!
//! A convolution sums in the same order for any number of threads (tests/threads.rs holds the
//! bits). Processors with vectors of another width may differ in the last bits.
//!
//! Cost: 40 ms for 192 x 192 px with AVX-512 on one thread; a second thread saves up to a quarter.
//! Reading the file takes 5 ms. Limits: a file may ask for any amount of memory, so
//! [`PartsNetwork::load`] reads none but the one whose digest it knows.

use crate::error::RecogniseError;
use crate::fields;
use crate::weights::DIGEST;
use crate::words::{GarmentKind, Landmark, Lie, Limb, Part};
use rten::{
    Dimension, LoadErrorKind, Model, ModelOptions, NodeId, RunOptions, ThreadPool, TryFromValueError, Value,
    ValueView,
};
use std::sync::Arc;
use toile_core::artifact::Digester;
use toile_core::panics::caught;

/// Width and height of the square that the network takes, px.
pub const SIDE: usize = 192;
/// Width and height of a cell of its maps, px of the square.
pub const STRIDE: usize = 4;
/// Cells along each side of its maps.
pub const GRID: usize = SIDE / STRIDE;

/// The name of what it takes, and its shape: photos, channels, rows, columns.
const TAKES: [usize; 4] = [1, 3, SIDE, SIDE];
/// The longest message of the runtime that is repeated, characters.
const MAX_WORDS: usize = 200;

/// What it gives: names, and shapes behind the first side, which is 1.
const GIVES: [(&str, &[usize]); 6] = [
    ("parts", &[Part::ALL.len(), GRID, GRID]),
    ("landmarks", &[Landmark::ALL.len(), GRID, GRID]),
    ("presence", &[Landmark::ALL.len()]),
    ("kinds", &[GarmentKind::ALL.len()]),
    ("lies", &[Limb::ALL.len() * Lie::ALL.len()]),
    ("flags", &[3]),
];

/// What it gives, as logits: finite, each list of the length that its name has in `GIVES`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Logits {
    pub(crate) parts: Vec<f32>,
    pub(crate) landmarks: Vec<f32>,
    pub(crate) presence: Vec<f32>,
    pub(crate) kinds: Vec<f32>,
    pub(crate) lies: Vec<f32>,
    pub(crate) flags: Vec<f32>,
}

/// A network that is ready to be run.
#[derive(Debug)]
pub struct PartsNetwork {
    model: Model,
    input: NodeId,
    outputs: [NodeId; 6],
}

impl PartsNetwork {
    /// The network of the file that the program was built for.
    ///
    /// # Errors
    /// The file has another digest than [`DIGEST`], and those of [`PartsNetwork::load_other`].
    pub fn load(file: &[u8]) -> Result<PartsNetwork, RecogniseError> {
        let found = Digester::new().bytes(file).finish().hex();
        match found == DIGEST {
            true => PartsNetwork::load_other(file),
            false => Err(RecogniseError::OtherFile { found, wanted: DIGEST }),
        }
    }

    /// The network of any file, such as one that has just been trained; of a file that is trusted.
    ///
    /// # Errors
    /// The file is no ONNX file, is damaged, uses operators that the network does not use, or takes
    /// or gives other shapes.
    pub fn load_other(file: &[u8]) -> Result<PartsNetwork, RecogniseError> {
        if !fields::skips_forward(file) {
            return Err(RecogniseError::NoOnnx);
        }
        let model = caught(|| options().load(file.to_vec())).map_err(broken)?;
        let model = model.map_err(|e| match e.kind() {
            LoadErrorKind::UnknownFileType | LoadErrorKind::FormatNotEnabled => RecogniseError::NoOnnx,
            LoadErrorKind::ParseError => RecogniseError::Damaged,
            _ => RecogniseError::Unreadable(short(&e.to_string())),
        })?;
        let input = one_input(&model)?;
        let [a, b, c, d, e, f] = GIVES.map(|(name, shape)| output(&model, name, shape));
        Ok(PartsNetwork { model, input, outputs: [a?, b?, c?, d?, e?, f?] })
    }

    /// What it gives for a photo in the square, on so many threads, at least one.
    ///
    /// # Errors
    /// It breaks off, gives another shape, or values that are not finite.
    pub(crate) fn logits(&self, levels: &[f32], threads: usize) -> Result<Logits, RecogniseError> {
        let made = caught(|| self.run(levels, threads)).map_err(broken)??;
        let [parts, landmarks, presence, kinds, lies, flags] = made;
        Ok(Logits {
            parts: map(parts, 0)?,
            landmarks: map(landmarks, 1)?,
            presence: list(presence, 2)?,
            kinds: list(kinds, 3)?,
            lies: list(lies, 4)?,
            flags: list(flags, 5)?,
        })
    }

    fn run(&self, levels: &[f32], threads: usize) -> Result<[Value; 6], RecogniseError> {
        let photo = ValueView::from_shape(TAKES, levels).map_err(|e| broken(e.to_string()))?;
        let pool = Arc::new(ThreadPool::with_num_threads(threads.max(1)));
        let options = RunOptions::default().with_thread_pool(Some(pool));
        let made = self.model.run_n(vec![(self.input, photo.into())], self.outputs, Some(options));
        made.map_err(|e| broken(e.to_string()))
    }
}

/// The operators that the network may be made of. There is no loop among them, so that every run
/// ends.
fn options() -> ModelOptions {
    ModelOptions::with_ops(rten::op_registry!(
        Add,
        AveragePool,
        BatchNormalization,
        Clip,
        Concat,
        Conv,
        Div,
        Flatten,
        Gemm,
        GlobalAveragePool,
        Identity,
        MatMul,
        MaxPool,
        Mul,
        ReduceMean,
        Relu,
        Reshape,
        Resize,
        Sigmoid,
        Softmax,
        Squeeze,
        Sub,
        Transpose,
        Unsqueeze
    ))
}

/// The only input, where it is a photo in the square.
fn one_input(model: &Model) -> Result<NodeId, RecogniseError> {
    let takes = |found| Err(RecogniseError::Takes { found, wanted: words(&TAKES) });
    let &[input] = model.input_ids() else {
        return takes(format!("{} inputs", model.input_ids().len()));
    };
    match model.node_info(input).and_then(|info| info.shape()) {
        Some(shape) if !fits(&shape, &TAKES) => takes(dimensions(&shape)),
        _ => Ok(input),
    }
}

/// The output of that name, where it can have that shape.
fn output(model: &Model, name: &'static str, shape: &[usize]) -> Result<NodeId, RecogniseError> {
    let is_named = |id: &&NodeId| model.node_info(**id).is_some_and(|info| info.name() == Some(name));
    let &output = model.output_ids().iter().find(is_named).ok_or(RecogniseError::GivesNo(name))?;
    match model.node_info(output).and_then(|info| info.shape()) {
        Some(stated) if !fits(&stated, &whole(shape)) => Err(gives(name, shape, dimensions(&stated))),
        _ => Ok(output),
    }
}

/// The values of an output that is a map.
fn map(made: Value, output: usize) -> Result<Vec<f32>, RecogniseError> {
    values(made.into_shape_vec::<f32, 4>(), output)
}

/// The values of an output that is a list.
fn list(made: Value, output: usize) -> Result<Vec<f32>, RecogniseError> {
    values(made.into_shape_vec::<f32, 2>(), output)
}

/// The values of an output, if they are the wanted ones.
fn values<const N: usize>(
    made: Result<([usize; N], Vec<f32>), TryFromValueError>,
    output: usize,
) -> Result<Vec<f32>, RecogniseError> {
    let (name, shape) = GIVES[output];
    match made {
        Ok((found, _)) if found[..] != whole(shape) => Err(gives(name, shape, words(&found))),
        Ok((_, values)) if values.iter().all(|v| v.is_finite()) => Ok(values),
        Ok(_) => Err(RecogniseError::NoNumbers(name)),
        Err(TryFromValueError::WrongRank { actual, .. }) => {
            Err(gives(name, shape, format!("{actual} dimensions")))
        }
        Err(_) => Err(gives(name, shape, "values of another type".into())),
    }
}

fn gives(output: &'static str, shape: &[usize], found: String) -> RecogniseError {
    RecogniseError::Gives { output, found, wanted: words(&whole(shape)) }
}

/// The shape of an output, its first side included.
fn whole(shape: &[usize]) -> Vec<usize> {
    [&[1], shape].concat()
}

fn broken(said: String) -> RecogniseError {
    RecogniseError::Broken(short(&said))
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

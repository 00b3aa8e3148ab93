//! A writer of ONNX files for networks of a few nodes: protocol buffers by hand, fields as numbered
//! in `onnx.proto3`.

/// A message under way.
#[derive(Default)]
struct Message(Vec<u8>);

impl Message {
    fn varint(mut self, mut v: u64) -> Self {
        while v >= 0x80 {
            self.0.push(v as u8 | 0x80);
            v >>= 7;
        }
        self.0.push(v as u8);
        self
    }

    fn number(self, field: u64, v: u64) -> Self {
        self.varint(field << 3).varint(v)
    }

    fn bytes(self, field: u64, bytes: &[u8]) -> Self {
        let mut with = self.varint(field << 3 | 2).varint(bytes.len() as u64);
        with.0.extend_from_slice(bytes);
        with
    }

    fn text(self, field: u64, text: &str) -> Self {
        self.bytes(field, text.as_bytes())
    }

    fn message(self, field: u64, inner: Message) -> Self {
        self.bytes(field, &inner.0)
    }
}

/// An operator with the names of what it takes, the name of what it gives, and whether a
/// convolution goes in steps of its own size.
#[derive(Clone)]
pub(crate) struct Node {
    pub operator: &'static str,
    pub takes: Vec<&'static str>,
    pub gives: &'static str,
    pub steps: u64,
}

/// Values by name: shape, in which 0 is a side that is left open, or none where it is not stated.
pub(crate) type Stated = (&'static str, Option<Vec<u64>>);

/// A network.
#[derive(Clone)]
pub(crate) struct Net {
    pub takes: Vec<Stated>,
    pub gives: Vec<Stated>,
    pub nodes: Vec<Node>,
    /// Constants by name: shape and values.
    pub constants: Vec<(&'static str, Vec<u64>, Vec<f32>)>,
}

impl Net {
    /// The file.
    pub(crate) fn file(&self) -> Vec<u8> {
        let opset = Message::default().number(2, 13);
        Message::default().number(1, 7).message(7, self.graph()).message(8, opset).0
    }

    fn graph(&self) -> Message {
        let mut graph = Message::default().text(2, "tiny");
        for node in &self.nodes {
            graph = graph.message(1, written(node));
        }
        for (name, shape, values) in &self.constants {
            graph = graph.message(5, constant(name, shape, values));
        }
        for (field, stated) in [(11, &self.takes), (12, &self.gives)] {
            for (name, shape) in stated {
                graph = graph.message(field, value(name, shape.as_deref()));
            }
        }
        graph
    }
}

fn written(node: &Node) -> Message {
    let fed = node.takes.iter().fold(Message::default(), |made, name| made.text(1, name));
    let made = fed.text(2, node.gives).text(3, &format!("{}_node", node.gives)).text(4, node.operator);
    match node.operator {
        "Conv" => [("strides", [node.steps; 2].as_slice()), ("dilations", &[1; 2]), ("pads", &[0; 4])]
            .into_iter()
            .fold(made, |made, (name, values)| made.message(5, attribute(name, values))),
        _ => made,
    }
}

/// A list of whole numbers.
fn attribute(name: &str, values: &[u64]) -> Message {
    let named = Message::default().text(1, name);
    values.iter().fold(named, |list, v| list.number(8, *v)).number(20, 7)
}

fn constant(name: &str, shape: &[u64], values: &[f32]) -> Message {
    let dims = shape.iter().fold(Message::default(), |tensor, n| tensor.number(1, *n));
    let raw: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    dims.number(2, 1).text(8, name).bytes(9, &raw)
}

fn value(name: &str, shape: Option<&[u64]>) -> Message {
    let side = |n: &u64| match n {
        0 => Message::default().text(2, "n"),
        n => Message::default().number(1, *n),
    };
    let tensor = Message::default().number(1, 1);
    let tensor = match shape {
        Some(shape) => tensor.message(2, shape.iter().fold(Message::default(), |s, n| s.message(1, side(n)))),
        None => tensor,
    };
    Message::default().text(1, name).message(2, Message::default().message(1, tensor))
}

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

/// A network of a chain of nodes, `x` first, each fed by the one before it and by the constants
/// that it names.
pub(crate) struct Net {
    /// Shape of what it takes; a side of 0 is left open.
    pub takes: Vec<u64>,
    /// Shape of what it says that it gives; none where it does not say.
    pub gives: Option<Vec<u64>>,
    /// Operators, each with the constants beside its first input.
    pub nodes: Vec<(&'static str, Vec<&'static str>)>,
    /// Constants by name: shape and values.
    pub constants: Vec<(&'static str, Vec<u64>, Vec<f32>)>,
    /// How many further inputs it has that nothing uses.
    pub spare: usize,
}

impl Net {
    /// The file.
    pub(crate) fn file(&self) -> Vec<u8> {
        let opset = Message::default().number(2, 13);
        Message::default().number(1, 7).message(7, self.graph()).message(8, opset).0
    }

    fn graph(&self) -> Message {
        let mut graph = Message::default().text(2, "tiny");
        for (i, (operator, constants)) in self.nodes.iter().enumerate() {
            graph = graph.message(1, node(i, operator, constants));
        }
        for (name, shape, values) in &self.constants {
            graph = graph.message(5, constant(name, shape, values));
        }
        graph = graph.message(11, value("x0", Some(&self.takes)));
        for i in 0..self.spare {
            graph = graph.message(11, value(&format!("spare{i}"), Some(&self.takes)));
        }
        graph.message(12, value(&format!("x{}", self.nodes.len()), self.gives.as_deref()))
    }
}

fn node(i: usize, operator: &str, constants: &[&str]) -> Message {
    let fed = Message::default().text(1, &format!("x{i}"));
    let fed = constants.iter().fold(fed, |node, name| node.text(1, name));
    let node = fed.text(2, &format!("x{}", i + 1)).text(3, &format!("node{i}")).text(4, operator);
    match operator {
        "Conv" => [("strides", [1; 2].as_slice()), ("dilations", &[1; 2]), ("pads", &[0; 4])]
            .into_iter()
            .fold(node, |node, (name, values)| node.message(5, attribute(name, values))),
        _ => node,
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

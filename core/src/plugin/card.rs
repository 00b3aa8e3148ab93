//! The tables of a plugin's stages, made from their cards.

use super::abi::{self, Text};
use crate::param::Finer;
use crate::{Arity, Card, InPort, OutPort, ParamDoc};

/// The plugin's own tables of a card that lives as long as the library.
pub(super) fn table(card: &'static Card) -> abi::StageTable {
    let contracts: &[Text] = leak(card.contracts.iter().map(|c| Text::of(c.as_str())));
    let params: &[abi::Param] = leak(card.params.iter().map(param));
    let inputs: &[abi::Port] = leak(card.inputs.iter().map(in_port));
    let outputs: &[abi::Port] = leak(card.outputs.iter().map(out_port));
    abi::StageTable {
        version: card.version,
        reserved: 0,
        name: Text::of(card.name),
        role: Text::of(card.role.as_str()),
        doc: Text::of(card.doc),
        source: Text::of(card.source),
        example: Text::of(card.example),
        contracts: contracts.as_ptr(),
        contract_count: contracts.len(),
        params: params.as_ptr(),
        param_count: params.len(),
        inputs: inputs.as_ptr(),
        input_count: inputs.len(),
        outputs: outputs.as_ptr(),
        output_count: outputs.len(),
        create: None,
        describe: None,
        run: None,
        destroy: None,
        check: None,
    }
}

fn leak<T>(items: impl Iterator<Item = T>) -> &'static [T] {
    Box::leak(items.collect::<Vec<T>>().into_boxed_slice())
}

fn param(p: &'static ParamDoc) -> abi::Param {
    abi::Param {
        name: Text::of(p.name),
        doc: Text::of(p.doc),
        kind: Text::of(&p.kind),
        unit: Text::of(p.unit),
        default: Text::of(&p.default),
        min: p.min.unwrap_or(f64::NAN),
        max: p.max.unwrap_or(f64::NAN),
        flags: flags(p),
        reserved: 0,
    }
}

fn flags(p: &ParamDoc) -> u32 {
    let finer = match p.finer {
        Some(Finer::Less) => abi::PARAM_FINER_LESS,
        Some(Finer::More) => abi::PARAM_FINER_MORE,
        None => 0,
    };
    let (trades, way) = (u32::from(p.trades) * abi::PARAM_TRADES, u32::from(p.way) * abi::PARAM_WAY);
    finer | trades | way
}

fn in_port(p: &'static InPort) -> abi::Port {
    let optional = if p.optional { abi::PORT_OPTIONAL } else { 0 };
    let original = if p.original { abi::PORT_ORIGINAL } else { 0 };
    let arity = arity_number(p.arity);
    abi::Port { name: Text::of(p.name), kind: Text::of(p.kind.0), arity, flags: optional | original }
}

fn out_port(p: &'static OutPort) -> abi::Port {
    abi::Port { name: Text::EMPTY, kind: Text::of(p.kind.0), arity: arity_number(p.arity), flags: 0 }
}

fn arity_number(arity: Arity) -> u32 {
    match arity {
        Arity::One => abi::ARITY_ONE,
        Arity::Each => abi::ARITY_EACH,
        Arity::All => abi::ARITY_ALL,
    }
}

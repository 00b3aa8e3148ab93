//! Stage cards, read from the tables of a plugin.

use toile_core::RunLog;
use toile_core::artifact::ArtifactType;
use toile_core::artifact::stored::kind_named;
use toile_core::param::{Check, Finer, check_number};
use toile_core::plugin::abi::{self, Text};
use toile_core::plugin::view::{list, text};
use toile_core::text::intern;
use toile_core::{
    Arity, Card, Contract, InPort, Kind, Length, OutPort, ParamDoc, ParamFault, PluginId, Role,
};

/// The most parameters or ports that a stage may have.
const MAX_ITEMS: usize = 1000;

/// How far the items of each kind of list lie apart in a plugin's memory.
#[derive(Debug, Clone, Copy)]
pub(super) struct Strides {
    pub(super) param: usize,
    pub(super) port: usize,
}

/// Reads a stage's card from its table.
///
/// Errors: one sentence on what cannot be.
///
/// # Safety
/// All that the table points at is there.
pub(super) unsafe fn read(
    table: &abi::StageTable,
    strides: Strides,
    plugin: PluginId,
    check: impl Fn(usize) -> Option<Check>,
) -> Result<Card, String> {
    let name = unsafe { name_of(table.name)? };
    let fault = |what: String| format!("its stage `{name}`: {what}");
    let role_word = unsafe { text(table.role)? };
    let role = Role::named(role_word).ok_or_else(|| fault(format!("there is no role `{role_word}`")))?;
    let words = unsafe { list::<Text>(table.contracts.cast(), table.contract_count, "contracts")? };
    let contracts = words.iter().map(|w| contract(unsafe { text(*w)? }));
    let contracts = contracts.collect::<Result<_, String>>().map_err(fault)?;
    let params = unsafe { spaced::<abi::Param>(table.params.cast(), table.param_count, strides.param) };
    let params = params.map_err(fault)?;
    let params = params.iter().enumerate().map(|(i, p)| unsafe { read_param(p, check(i)) });
    let inputs = unsafe { spaced::<abi::Port>(table.inputs.cast(), table.input_count, strides.port) };
    let inputs = inputs.map_err(fault)?;
    let outputs = unsafe { spaced::<abi::Port>(table.outputs.cast(), table.output_count, strides.port) };
    let outputs = outputs.map_err(fault)?;
    if outputs.is_empty() {
        return Err(fault("it gives nothing".into()));
    }
    Ok(Card {
        name,
        role,
        doc: intern(unsafe { text(table.doc)? }),
        source: intern(unsafe { text(table.source)? }),
        version: table.version,
        example: intern(unsafe { text(table.example)? }),
        contracts,
        params: params.collect::<Result<_, _>>().map_err(fault)?,
        inputs: inputs.iter().map(|p| unsafe { read_in(p) }).collect::<Result<_, _>>().map_err(fault)?,
        outputs: outputs.iter().map(|p| unsafe { read_out(p) }).collect::<Result<_, _>>().map_err(fault)?,
        package: intern(&format!("{} {}", plugin.name, plugin.version)),
        plugin: Some(plugin),
    })
}

/// A stage's name: a word that a pipeline file can hold.
unsafe fn name_of(name: Text) -> Result<&'static str, String> {
    let name = unsafe { text(name)? };
    let fit = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let starts = name.chars().next().is_some_and(|c| c.is_ascii_alphabetic());
    match starts && name.len() <= 64 && name.chars().all(fit) {
        true => Ok(intern(name)),
        false => Err(format!("\"{}\" is no name for a stage", name.escape_debug())),
    }
}

fn contract(word: &str) -> Result<Contract, String> {
    Contract::named(word).ok_or_else(|| format!("there is no contract `{word}`"))
}

/// Items that lie `stride` bytes apart, of which the first bytes are known.
unsafe fn spaced<T: Copy>(
    ptr: *const std::ffi::c_void,
    count: usize,
    stride: usize,
) -> Result<Vec<T>, String> {
    if count > MAX_ITEMS {
        return Err(format!("it lists {count} items, the limit is {MAX_ITEMS}"));
    }
    if count > 0 && (ptr.is_null() || !ptr.cast::<T>().is_aligned()) {
        return Err(format!("it lists {count} items at no proper address"));
    }
    Ok((0..count).map(|i| unsafe { ptr.byte_add(i * stride).cast::<T>().read() }).collect())
}

unsafe fn read_param(p: &abi::Param, check: Option<Check>) -> Result<ParamDoc, String> {
    let name = intern(unsafe { text(p.name)? });
    if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Err(format!("\"{}\" is no name for a parameter", name.escape_debug()));
    }
    Ok(ParamDoc {
        name,
        doc: intern(unsafe { text(p.doc)? }),
        kind: unsafe { text(p.kind)? }.to_owned(),
        unit: intern(unsafe { text(p.unit)? }),
        min: (!p.min.is_nan()).then_some(p.min),
        max: (!p.max.is_nan()).then_some(p.max),
        default: unsafe { text(p.default)? }.to_owned(),
        trades: p.flags & abi::PARAM_TRADES != 0,
        finer: finer(name, p.flags)?,
        way: p.flags & abi::PARAM_WAY != 0,
        check: check.unwrap_or_else(|| Check::by(by_kind)),
    })
}

/// The check of a plugin that brings none: by the words for its type.
fn by_kind(value: &str, doc: &ParamDoc) -> Result<(), ParamFault> {
    match doc.kind.as_str() {
        "number" => Check::of::<f64>().run(value, doc),
        "whole number" => Check::of::<i64>().run(value, doc),
        "length" => Check::of::<Length>().run(value, doc),
        "true | false" => Check::of::<bool>().run(value, doc),
        "text" => Check::of::<String>().run(value, doc),
        // What it may be is known to the plugin alone, which says so when the stage is made.
        _ => Ok(()),
    }
}

/// The fault of a value that a plugin refused without a message.
pub(super) fn out_of_range(value: &str, doc: &ParamDoc) -> Option<String> {
    value.parse().ok().and_then(|x| check_number(x, doc).err())
}

/// Which way a parameter is refined, by its flags.
fn finer(name: &str, flags: u32) -> Result<Option<Finer>, String> {
    match (flags & abi::PARAM_FINER_LESS != 0, flags & abi::PARAM_FINER_MORE != 0) {
        (true, true) => {
            Err(format!("the parameter `{name}` is finer both where it is less and where it is more"))
        }
        (true, false) => Ok(Some(Finer::Less)),
        (false, true) => Ok(Some(Finer::More)),
        (false, false) => Ok(None),
    }
}

unsafe fn read_in(p: &abi::Port) -> Result<InPort, String> {
    Ok(InPort {
        name: intern(unsafe { text(p.name)? }),
        kind: unsafe { kind(p)? },
        arity: arity(p.arity)?,
        optional: p.flags & abi::PORT_OPTIONAL != 0,
        original: p.flags & abi::PORT_ORIGINAL != 0,
        sewn: false,
    })
}

unsafe fn read_out(p: &abi::Port) -> Result<OutPort, String> {
    Ok(OutPort { kind: unsafe { kind(p)? }, arity: arity(p.arity)? })
}

unsafe fn kind(p: &abi::Port) -> Result<Kind, String> {
    let word = unsafe { text(p.kind)? };
    match kind_named(word) {
        Some(kind) if kind == RunLog::KIND => Err("a run log cannot be passed to plugins".into()),
        Some(kind) => Ok(kind),
        None => Err(format!("there is no kind `{word}`")),
    }
}

fn arity(number: u32) -> Result<Arity, String> {
    match number {
        abi::ARITY_ONE => Ok(Arity::One),
        abi::ARITY_EACH => Ok(Arity::Each),
        abi::ARITY_ALL => Ok(Arity::All),
        other => Err(format!("a port has the unknown arity {other}")),
    }
}

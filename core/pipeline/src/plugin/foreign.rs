//! A plugin's stage behind the [`Stage`] trait.
//!
//! Every run of it goes on a thread of its own, for which the runner's thread waits, and whose
//! loops and words it serves: a run that does not stop when it is asked to is left behind, and the
//! program goes on.

use super::call::{CallState, Message, PluginFailure, PluginLoop};
use super::card;
use super::loaded::LoadedLibrary;
use rayon::prelude::*;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::any::Any;
use std::ffi::c_void;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};
use toile_core::artifact::{Collider, Digest};
use toile_core::plugin::abi::{self, Text};
use toile_core::plugin::inside::{inside, long};
use toile_core::plugin::view::Lent;
use toile_core::plugin::{Make, collide};
use toile_core::text::intern;
use toile_core::typetag;
use toile_core::{
    Cancel, Card, Context, ErrorCode, Inputs, ParamDoc, ParamFault, PortValue, Stage, StageError,
};

/// How long a stage may go on after it has been asked to stop, before it is left behind.
const GRACE: Duration = Duration::from_secs(2);
/// How often the waiting thread looks whether the user has asked to stop.
const LOOK: Duration = Duration::from_millis(10);
/// Stack of a plugin's thread, bytes: that of a main thread.
const STACK: usize = 8 << 20;

/// Runs of plugins' stages that are waited for.
static WAITED_FOR: AtomicUsize = AtomicUsize::new(0);

/// How long a program that asks everything to stop has to wait until it is told which plugin does
/// not; nothing while no plugin is at work.
pub fn patience() -> Duration {
    if WAITED_FOR.load(Ordering::SeqCst) > 0 { GRACE } else { Duration::ZERO }
}

/// A run is waited for until this is dropped.
struct Waiting;

impl Waiting {
    fn new() -> Self {
        WAITED_FOR.fetch_add(1, Ordering::SeqCst);
        Waiting
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        WAITED_FOR.fetch_sub(1, Ordering::SeqCst);
    }
}

/// A stage type of a plugin.
#[derive(Debug, Clone)]
pub(super) struct ForeignType {
    pub(super) library: Arc<LoadedLibrary>,
    pub(super) table: abi::StageTable,
}

/// A stage that a plugin has made, destroyed with its last user.
struct ForeignObject {
    of: ForeignType,
    stage: *mut c_void,
}

// Its functions may be called from any thread, by the rules of the border.
unsafe impl Send for ForeignObject {}
unsafe impl Sync for ForeignObject {}

impl Drop for ForeignObject {
    fn drop(&mut self) {
        if let Some(destroy) = self.of.table.destroy {
            let _inside = inside(self.of.library.words());
            unsafe { destroy(self.stage) };
        }
    }
}

/// A plugin's stage with its parameters set.
struct ForeignStage {
    card: Card,
    params: String,
    object: Arc<ForeignObject>,
}

impl std::fmt::Debug for ForeignStage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", self.card.name, self.params)
    }
}

impl Make for ForeignType {
    /// Errors: the plugin's own sentence.
    fn make(&self, card: &Card, arguments: &str) -> Result<Box<dyn Stage>, String> {
        let create = self.table.create.ok_or("the plugin cannot make it")?;
        let (call, _) = CallState::new(&self.library, &[], &Cancel::new());
        let mut stage = std::ptr::null_mut();
        let _inside = long(self.library.words(), &format!("while it makes its stage `{}`", card.name));
        let status = unsafe { create(Text::of(arguments), &call.host(), &mut stage) };
        self.done(status, &call).map_err(|e| e.message)?;
        let object = Arc::new(ForeignObject { of: self.clone(), stage });
        let params = object.describe().map_err(|e| e.message)?;
        Ok(Box::new(ForeignStage { card: card.clone(), params, object }))
    }
}

impl ForeignType {
    /// Checks a text as the value of a parameter.
    pub(super) fn check(&self, param: usize, value: &str, doc: &ParamDoc) -> Result<(), ParamFault> {
        let Some(check) = self.table.check else { return Ok(()) };
        let (call, _) = CallState::new(&self.library, &[], &Cancel::new());
        let mut offset = -1;
        let _inside = long(self.library.words(), &format!("while it checks `{}`", doc.name));
        let status = unsafe { check(param, Text::of(value), &call.host(), &mut offset) };
        if status == abi::OK {
            return Ok(());
        }
        let told = call.take_failure().unwrap_or_default();
        let message = match told.message.as_str() {
            "" => card::out_of_range(value, doc)
                .unwrap_or_else(|| format!("`{}` wants a {}", doc.name, doc.kind)),
            message => message.to_owned(),
        };
        let reason = if told.about.is_empty() { message.clone() } else { told.about };
        let hint = (!told.hint.is_empty()).then_some(told.hint);
        Err(ParamFault { message, reason, hint, offset: usize::try_from(offset).ok() })
    }

    /// The outcome of a call.
    fn done(&self, status: i32, call: &CallState) -> Result<(), StageError> {
        let of = self.library.words();
        let bug = "this is a bug of the plugin, please report it to its author";
        let told = call.take_failure();
        match (status, told) {
            (abi::OK, None) => Ok(()),
            (abi::PANICKED, told) => {
                let message = told.map(|t| t.message).unwrap_or_default();
                Err(StageError::internal(format!("{of} panicked: {message}")).hint(bug))
            }
            (abi::OK | abi::FAILED, Some(told)) => Err(self.error(told)),
            (abi::FAILED, None) => {
                Err(StageError::internal(format!("{of} failed and did not say why")).hint(bug))
            }
            (other, _) => {
                Err(StageError::internal(format!("{of} gave back {other}, which means nothing")).hint(bug))
            }
        }
    }

    fn error(&self, told: PluginFailure) -> StageError {
        let code = ErrorCode::named(&told.code).unwrap_or(ErrorCode::InvalidInput);
        let message = match code {
            ErrorCode::Internal => format!("{}: {}", self.library.words(), told.message),
            _ => told.message,
        };
        let mut error = StageError::new(code, message);
        if !told.hint.is_empty() {
            error = error.hint(told.hint);
        }
        if !told.about.is_empty() {
            error = error.at(intern(&told.about));
        }
        error
    }
}

impl ForeignObject {
    fn describe(&self) -> Result<String, StageError> {
        let Some(describe) = self.of.table.describe else { return Ok("()".into()) };
        let (call, _) = CallState::new(&self.of.library, &[], &Cancel::new());
        let _inside = inside(self.of.library.words());
        let status = unsafe { describe(self.stage, &call.host()) };
        self.of.done(status, &call)?;
        Ok(call.take_answer())
    }

    /// Calls the plugin; gives back its status.
    fn run(&self, call: &CallState, inputs: &Inputs, names: &RunNames) -> i32 {
        let Some(run) = self.of.table.run else { return abi::FAILED };
        let fed: Vec<u32> = inputs.0.iter().map(|v| how_fed(v.as_ref())).collect();
        let lent = lend(inputs);
        let views: Vec<abi::Input> = lent.iter().map(LentInput::view).collect();
        let asked = abi::Call {
            size: size_of::<abi::Call>() as u32,
            ports: fed.len() as u32,
            fed: fed.as_ptr(),
            inputs: views.as_ptr(),
            count: views.len(),
            stage: Text::of(&names.stage),
            entry: Text::of(&names.entry),
            base: Text::of(&names.base),
        };
        unsafe { run(self.stage, &names.host(call), &asked) }
    }
}

fn how_fed(value: Option<&PortValue>) -> u32 {
    match value {
        None => abi::FED_NOTHING,
        Some(PortValue::One(_)) => abi::FED_ONE,
        Some(PortValue::Set(..)) => abi::FED_SET,
    }
}

/// An input in C's form, with what it borrows.
struct LentInput<'a> {
    port: u32,
    kind: &'static str,
    name: &'a str,
    record: Option<Lent<'a>>,
    collider: Option<Box<abi::Collider>>,
}

impl LentInput<'_> {
    fn view(&self) -> abi::Input {
        abi::Input {
            port: self.port,
            reserved: 0,
            kind: Text::of(self.kind),
            name: Text::of(self.name),
            record: self.record.as_ref().map_or(std::ptr::null(), Lent::as_ptr),
            collider: self.collider.as_ref().map_or(std::ptr::null(), |c| &raw const **c),
        }
    }
}

impl Drop for LentInput<'_> {
    fn drop(&mut self) {
        if let Some(collider) = &self.collider
            && let Some(destroy) = unsafe { &*collider.table }.destroy
        {
            unsafe { destroy(collider.this) };
        }
    }
}

fn lend(inputs: &Inputs) -> Vec<LentInput<'_>> {
    let values = inputs.0.iter().enumerate().filter_map(|(i, v)| Some((i as u32, v.as_ref()?)));
    let entries = values.flat_map(|(port, v)| v.entries().into_iter().map(move |(n, a)| (port, n, a)));
    let lent = entries.map(|(port, name, artifact)| {
        let any: &dyn Any = artifact.as_ref();
        let collider = any.downcast_ref::<Collider>().map(|c| Box::new(collide::lend(c)));
        let record = artifact.record().map(Lent::of);
        LentInput { port, kind: artifact.kind().0, name, record, collider }
    });
    lent.collect()
}

/// What a run is called.
struct RunNames {
    stage: String,
    entry: String,
    base: String,
    threads: u32,
}

impl RunNames {
    fn host(&self, call: &CallState) -> abi::Host {
        // The plugin's thread is no thread of the pool, and would count wrongly.
        abi::Host { threads: self.threads, ..call.host() }
    }
}

#[typetag::serde(name = "a plugin's stage")]
impl Stage for ForeignStage {
    fn card(&self) -> Card {
        self.card.clone()
    }

    fn params(&self) -> String {
        self.params.clone()
    }

    fn run_ports(&self, inputs: &Inputs, cx: &Context) -> Result<Vec<PortValue>, StageError> {
        let of = &self.object.of;
        let (call, messages) = CallState::new(&of.library, &self.card.outputs, cx.cancel());
        let call = Arc::new(call);
        let names = RunNames {
            stage: cx.stage().to_owned(),
            entry: cx.entry().to_owned(),
            base: cx.base().to_string_lossy().into_owned(),
            threads: rayon::current_num_threads() as u32,
        };
        let (object, inputs, own) = (self.object.clone(), inputs.clone(), call.clone());
        let (plugin, stage) = (of.library.words(), format!("its stage `{}`", self.card.name));
        let work = move || {
            let status = {
                let _inside = long(plugin, &stage);
                object.run(&own, &inputs, &names)
            };
            // Nothing of the plugin's may be freed by this thread after the program was told.
            drop((object, inputs));
            own.tell_done(status);
        };
        let thread =
            std::thread::Builder::new().name(self.card.name.to_owned()).stack_size(STACK).spawn(work);
        thread.map_err(|e| StageError::internal(format!("there is no thread for a plugin: {e}")))?;
        let status = self.serve(&messages, cx)?;
        of.done(status, &call)?;
        call.outputs()
    }
}

impl ForeignStage {
    /// Serves the plugin's thread until it is done.
    fn serve(&self, messages: &Receiver<Message>, cx: &Context) -> Result<i32, StageError> {
        let _waiting = Waiting::new();
        let mut asked: Option<Instant> = None;
        loop {
            match messages.recv_timeout(LOOK) {
                Ok(Message::Progress(share, text)) => cx.progress(share, text),
                Ok(Message::Note(text)) => cx.note(text),
                Ok(Message::Warning(text)) => cx.warn(text),
                Ok(Message::Figure(name, value, unit)) => cx.figure(&name, value, intern(&unit)),
                Ok(Message::Read(path, digest)) => cx.note_read(&path, digest.map(Digest)),
                Ok(Message::Loop(work)) => serve_loop(&work, self.object.of.library.words()),
                Ok(Message::Done(status)) => return Ok(status),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    let message = format!("the thread of {} ended", self.object.of.library.words());
                    return Err(StageError::internal(message));
                }
            }
            if cx.cancel().is_cancelled() && asked.get_or_insert_with(Instant::now).elapsed() > GRACE {
                return Err(self.left_behind());
            }
        }
    }

    fn left_behind(&self) -> StageError {
        let (of, name) = (self.object.of.library.words(), self.card.name);
        let message = format!("{of} did not stop within {} s of being asked", GRACE.as_secs());
        StageError::new(ErrorCode::Cancelled, message)
            .hint(format!("its stage `{name}` does not ask often enough whether to stop; it was left behind"))
    }
}

fn serve_loop(work: &PluginLoop, plugin: &'static str) {
    let (body, data) = (work.body, SharedPointer(work.data));
    (0..work.count).into_par_iter().for_each(|i| {
        let _inside = inside(plugin);
        unsafe { body(data.get(), i) }
    });
    let _ = work.done.send(());
}

/// A pointer that a plugin shares among threads.
#[derive(Clone, Copy)]
struct SharedPointer(*mut c_void);

impl SharedPointer {
    fn get(self) -> *mut c_void {
        self.0
    }
}

unsafe impl Send for SharedPointer {}
unsafe impl Sync for SharedPointer {}

impl Serialize for ForeignStage {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(&format!("{self:?}"))
    }
}

impl<'de> Deserialize<'de> for ForeignStage {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(serde::de::Error::custom("a plugin's stage is made by its plugin"))
    }
}

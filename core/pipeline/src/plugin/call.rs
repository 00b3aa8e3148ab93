//! What the program offers to a plugin during one call, and what comes of it.

use super::loaded::LoadedLibrary;
use std::collections::BTreeMap;
use std::ffi::c_void;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use toile_core::artifact::stored::{Data, MemoryOwner, Record, from_record};
use toile_core::artifact::{Artifact, ArtifactType, Collider};
use toile_core::plugin::abi::{self, Text};
use toile_core::plugin::collide;
use toile_core::plugin::lending::Lending;
use toile_core::plugin::view::{record, text};
use toile_core::{Arity, Cancel, OutPort, PortValue, StageError};

/// What one call may claim: memory for outputs, bytes.
pub const MAX_OUTPUT_BYTES: u64 = 4 << 30;

/// What a plugin tells while it works; served by the thread that waits for it.
pub(super) enum Message {
    Progress(f64, String),
    Note(String),
    Warning(String),
    Figure(String, f64, String),
    /// A file was read, with the digest of its content where the plugin knows it.
    Read(String, Option<[u8; 32]>),
    /// A loop to be run on the program's threads.
    Loop(PluginLoop),
    /// The call is over, with this status.
    Done(i32),
}

/// A loop of a plugin.
pub(super) struct PluginLoop {
    pub(super) count: usize,
    pub(super) data: *mut c_void,
    pub(super) body: unsafe extern "C" fn(*mut c_void, usize),
    pub(super) done: Sender<()>,
}

// Its body may be called from any thread, by the rules of the border.
unsafe impl Send for PluginLoop {}

/// Why a plugin's call failed, in its own words.
#[derive(Debug, Clone, Default)]
pub(super) struct PluginFailure {
    pub(super) code: String,
    pub(super) message: String,
    pub(super) hint: String,
    pub(super) about: String,
}

/// The state behind [`abi::Host::ctx`].
pub(super) struct CallState {
    library: Arc<LoadedLibrary>,
    outputs: Vec<OutPort>,
    made: Mutex<BTreeMap<(u32, String), Arc<dyn Artifact>>>,
    /// Memory handed out, by its address.
    blocks: Mutex<BTreeMap<usize, OutputMemory>>,
    budget: Mutex<u64>,
    failure: Mutex<Option<PluginFailure>>,
    answer: Mutex<String>,
    messages: Sender<Message>,
    cancel: Cancel,
}

/// Memory for an output, in 16-byte units.
#[derive(Clone)]
struct OutputMemory {
    memory: Arc<Vec<u128>>,
    /// As many bytes as were asked for.
    bytes: usize,
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl CallState {
    /// A call that may give to those ports.
    pub(super) fn new(
        library: &Arc<LoadedLibrary>,
        outputs: &[OutPort],
        cancel: &Cancel,
    ) -> (Self, Receiver<Message>) {
        let (messages, receiver) = channel();
        let call = CallState {
            library: library.clone(),
            outputs: outputs.to_vec(),
            made: Mutex::default(),
            blocks: Mutex::default(),
            budget: Mutex::new(MAX_OUTPUT_BYTES),
            failure: Mutex::default(),
            answer: Mutex::default(),
            messages,
            cancel: cancel.clone(),
        };
        (call, receiver)
    }

    /// The functions that reach this call; it must outlive them.
    pub(super) fn host(&self) -> abi::Host {
        abi::Host {
            size: size_of::<abi::Host>() as u32,
            major: abi::MAJOR,
            minor: abi::MINOR,
            threads: rayon::current_num_threads() as u32,
            ctx: std::ptr::from_ref(self).cast_mut().cast(),
            alloc: Some(alloc),
            give: Some(give),
            give_collider: Some(give_collider),
            answer: Some(answer),
            fail: Some(fail),
            warn: Some(warn),
            progress: Some(progress),
            figure: Some(figure),
            cancelled: Some(cancelled),
            parallel_for: Some(parallel_for),
            reads: Some(reads),
            note: Some(note),
        }
    }

    pub(super) fn tell_done(&self, status: i32) {
        let _ = self.messages.send(Message::Done(status));
    }

    pub(super) fn take_failure(&self) -> Option<PluginFailure> {
        locked(&self.failure).take()
    }

    pub(super) fn take_answer(&self) -> String {
        std::mem::take(&mut locked(&self.answer))
    }

    fn note(&self, message: String) {
        let failure = PluginFailure { code: "internal".into(), message, ..PluginFailure::default() };
        locked(&self.failure).get_or_insert(failure);
    }

    fn alloc(&self, bytes: usize) -> Result<*mut c_void, String> {
        let mut budget = locked(&self.budget);
        if bytes as u64 > *budget {
            return Err(format!(
                "it asks for {bytes} bytes, {} are left of the {MAX_OUTPUT_BYTES} that one run may have",
                *budget
            ));
        }
        let units = bytes.div_ceil(size_of::<u128>()).max(1);
        Vec::<u128>::new()
            .try_reserve_exact(units)
            .map_err(|_| format!("there is no memory for {bytes} bytes"))?;
        // Zero memory comes from the system untouched, page by page as it is used.
        let mut block = vec![0_u128; units];
        *budget -= bytes as u64;
        let at: *mut c_void = block.as_mut_ptr().cast();
        locked(&self.blocks).insert(at.addr(), OutputMemory { memory: Arc::new(block), bytes });
        Ok(at)
    }

    /// The port, where it is one and takes that name.
    fn port(&self, port: u32, name: &str) -> Result<&OutPort, String> {
        let of = self.outputs.get(port as usize);
        let of = of.ok_or_else(|| format!("it gave to output {port} of {}", self.outputs.len()))?;
        match (of.arity, name.is_empty()) {
            (Arity::All, true) => Err(format!("it gave a {} without a name to a set", of.kind)),
            (Arity::One | Arity::Each, false) => {
                Err(format!("it gave a {} named \"{name}\" where there is one only", of.kind))
            }
            _ => Ok(of),
        }
    }

    fn keep(&self, port: u32, name: &str, artifact: Arc<dyn Artifact>) -> Result<(), String> {
        let kind = artifact.kind();
        match locked(&self.made).insert((port, name.to_owned()), artifact) {
            None => Ok(()),
            Some(_) if name.is_empty() => Err(format!("it gave its {kind} twice")),
            Some(_) => Err(format!("it gave the {kind} \"{name}\" twice")),
        }
    }

    /// # Safety
    /// What the record points at is there.
    unsafe fn give(&self, port: u32, name: Text, view: *const abi::Record) -> Result<(), String> {
        let name = unsafe { text(name)? };
        let kind = self.port(port, name)?.kind;
        let mut budget = locked(&self.budget);
        let mut record = unsafe { record(view, &mut budget)? };
        drop(budget);
        self.own_blocks(&mut record);
        let of = if name.is_empty() { String::new() } else { format!(" \"{name}\"") };
        let artifact =
            from_record(kind, &record).map_err(|e| format!("its {kind}{of} cannot be used: {e}"))?;
        self.keep(port, name, artifact)
    }

    /// Lists that lie in memory of `alloc` are taken as they are: by the rules of the border nobody
    /// writes to what was given.
    fn own_blocks(&self, record: &mut Record<'_>) {
        let blocks = locked(&self.blocks);
        for field in &mut record.fields {
            let Data::U8(bytes) = &field.data else { continue };
            let block = blocks.get(&bytes.as_ptr().addr()).filter(|b| b.bytes >= bytes.len());
            if let Some(block) = block {
                field.owner = MemoryOwner::Foreign(Arc::new(Lending::block(block.memory.clone())));
            }
        }
    }

    /// # Safety
    /// The collider obeys the rules of the border.
    unsafe fn give_collider(&self, port: u32, collider: *const abi::Collider) -> Result<(), String> {
        let library: Arc<dyn Send + Sync> = self.library.clone();
        let owner = self.library.words();
        // Taken first, so that it is destroyed where it is not wanted.
        let collider = unsafe { collide::take(collider, owner, Some(library)) };
        let collider = collider.map_err(|e| format!("its collider cannot be used: {e}"))?;
        let kind = self.port(port, "")?.kind;
        if kind != Collider::KIND {
            return Err(format!("it gave a collider to an output that is a {kind}"));
        }
        collider.check().map_err(|e| format!("its collider cannot be used: {e}"))?;
        self.keep(port, "", Arc::new(collider))
    }

    /// What the call gave, port by port.
    ///
    /// Errors: an output is missing.
    pub(super) fn outputs(&self) -> Result<Vec<PortValue>, StageError> {
        let mut made = std::mem::take(&mut *locked(&self.made));
        let ports = self.outputs.iter().enumerate();
        ports.map(|(i, port)| self.output(i as u32, port, &mut made)).collect()
    }

    fn output(
        &self,
        index: u32,
        port: &OutPort,
        made: &mut BTreeMap<(u32, String), Arc<dyn Artifact>>,
    ) -> Result<PortValue, StageError> {
        if port.arity == Arity::All {
            let own = made.iter().filter(|((p, _), _)| *p == index);
            return Ok(PortValue::Set(port.kind, own.map(|((_, n), a)| (n.clone(), a.clone())).collect()));
        }
        let one = made.remove(&(index, String::new()));
        one.map(PortValue::One).ok_or_else(|| {
            StageError::internal(format!("{} did not give its {}", self.library.words(), port.kind))
                .hint("this is a bug of the plugin, please report it to its author")
        })
    }
}

/// The call behind a context pointer.
unsafe fn call<'a>(ctx: *mut c_void) -> &'a CallState {
    unsafe { &*ctx.cast::<CallState>() }
}

unsafe fn words(t: Text) -> String {
    unsafe { text(t) }.unwrap_or("").to_owned()
}

unsafe extern "C" fn alloc(ctx: *mut c_void, bytes: usize) -> *mut c_void {
    let call = unsafe { call(ctx) };
    call.alloc(bytes).unwrap_or_else(|e| {
        call.note(e);
        std::ptr::null_mut()
    })
}

unsafe extern "C" fn give(ctx: *mut c_void, port: u32, name: Text, record: *const abi::Record) -> i32 {
    let call = unsafe { call(ctx) };
    noted(call, unsafe { call.give(port, name, record) })
}

unsafe extern "C" fn give_collider(ctx: *mut c_void, port: u32, collider: *const abi::Collider) -> i32 {
    let call = unsafe { call(ctx) };
    noted(call, unsafe { call.give_collider(port, collider) })
}

fn noted(call: &CallState, outcome: Result<(), String>) -> i32 {
    match outcome {
        Ok(()) => abi::OK,
        Err(e) => {
            call.note(e);
            abi::FAILED
        }
    }
}

unsafe extern "C" fn answer(ctx: *mut c_void, text: Text) {
    *locked(&unsafe { call(ctx) }.answer) = unsafe { words(text) };
}

unsafe extern "C" fn fail(ctx: *mut c_void, code: Text, message: Text, hint: Text, about: Text) {
    let [code, message, hint, about] = [code, message, hint, about].map(|t| unsafe { words(t) });
    // What the program itself found comes first: the plugin only repeats that it failed.
    let failure = PluginFailure { code, message, hint, about };
    locked(&unsafe { call(ctx) }.failure).get_or_insert(failure);
}

unsafe extern "C" fn note(ctx: *mut c_void, text: Text) {
    let _ = unsafe { call(ctx).messages.send(Message::Note(words(text))) };
}

unsafe extern "C" fn warn(ctx: *mut c_void, text: Text) {
    let _ = unsafe { call(ctx).messages.send(Message::Warning(words(text))) };
}

unsafe extern "C" fn progress(ctx: *mut c_void, share: f64, text: Text) {
    let share = if share.is_nan() { 0.0 } else { share };
    let _ = unsafe { call(ctx).messages.send(Message::Progress(share, words(text))) };
}

unsafe extern "C" fn figure(ctx: *mut c_void, name: Text, value: f64, unit: Text) {
    let _ = unsafe { call(ctx).messages.send(Message::Figure(words(name), value, words(unit))) };
}

unsafe extern "C" fn cancelled(ctx: *mut c_void) -> u8 {
    u8::from(unsafe { call(ctx) }.cancel.is_cancelled())
}

unsafe extern "C" fn reads(ctx: *mut c_void, path: Text, digest: *const u8) {
    let digest = unsafe { digest.cast::<[u8; 32]>().as_ref() }.copied();
    let _ = unsafe { call(ctx).messages.send(Message::Read(words(path), digest)) };
}

unsafe extern "C" fn parallel_for(
    ctx: *mut c_void,
    count: usize,
    data: *mut c_void,
    body: Option<unsafe extern "C" fn(*mut c_void, usize)>,
) {
    let Some(body) = body else { return };
    let (done, wait) = channel();
    let sent = unsafe { call(ctx) }.messages.send(Message::Loop(PluginLoop { count, data, body, done }));
    if sent.is_err() || wait.recv().is_err() {
        // Nobody waits for this call any more: it may run to its end, but not on the program's
        // threads. A loop that was sent and then dropped has not been begun.
        (0..count).for_each(|i| unsafe { body(data, i) });
    }
}

//! The plugin's side: what the macro [`plugin!`](crate::plugin) puts behind a crate's stages.
//!
//! A stage written with `#[stage]` knows nothing of the plugin ABI: its artifacts are made from the
//! records that it is given, its context asks the program, and what it returns is lent as records.

use super::abi::{self, Text};
use super::guard::guarded;
use super::view::{Lent, record, text};
use super::{card, collide};
use crate::artifact::stored::{from_trusted_record, kind_named};
use crate::artifact::{Artifact, Collider};
use crate::context::Parallel;
use crate::param::ron_options;
use crate::{
    Cancel, Card, Context, ErrorCode, Event, Inputs, Listener, PortValue, StageError, StageType, panics,
};
use std::any::Any;
use std::collections::BTreeMap;
use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError, RwLock};

/// A crate's stage tables, made when they are first requested.
#[derive(Debug, Default)]
pub struct Tables(OnceLock<Vec<u64>>);

impl Tables {
    /// Not made yet.
    pub const fn new() -> Self {
        Tables(OnceLock::new())
    }

    /// What the entry point of the macro gives: `count` is null or the host's.
    ///
    /// Where the tables lie, one after the other, `stage_size(minor)` bytes apart.
    #[allow(clippy::not_unsafe_ptr_arg_deref)]
    pub fn give(&self, minor: u32, make: fn() -> Vec<abi::StageTable>, count: *mut usize) -> *const c_void {
        let stride = stage_size(minor) as usize;
        // A card that panics must not end the program: the library then has no stages.
        let made = || catch_unwind(AssertUnwindSafe(make)).map_err(panics::words).unwrap_or_default();
        let packed = self.0.get_or_init(|| pack(&made(), stride));
        if let Some(count) = unsafe { count.as_mut() } {
            *count = packed.len() * size_of::<u64>() / stride;
        }
        packed.as_ptr().cast()
    }
}

/// Bytes of a stage table in that minor version.
pub const fn stage_size(minor: u32) -> u32 {
    match minor {
        0 => abi::STAGE_SIZE_1_0,
        _ => size_of::<abi::StageTable>() as u32,
    }
}

/// The first `stride` bytes of every table.
fn pack(tables: &[abi::StageTable], stride: usize) -> Vec<u64> {
    let words = stride / size_of::<u64>();
    let mut packed = vec![0_u64; tables.len() * words];
    for (table, to) in tables.iter().zip(packed.chunks_exact_mut(words)) {
        let from = std::ptr::from_ref(table).cast::<u8>();
        unsafe { std::ptr::copy_nonoverlapping(from, to.as_mut_ptr().cast::<u8>(), stride) };
    }
    packed
}

/// A crate's declaration.
pub const fn declaration(
    name: &'static str,
    version: &'static str,
    minor: u32,
    stages: unsafe extern "C" fn(*mut usize) -> *const c_void,
) -> abi::Declaration {
    abi::Declaration {
        magic: abi::MAGIC,
        major: abi::MAJOR,
        minor,
        size: size_of::<abi::Declaration>() as u32,
        stage_size: stage_size(minor),
        param_size: size_of::<abi::Param>() as u32,
        port_size: size_of::<abi::Port>() as u32,
        name: Text::of(name),
        version: Text::of(version),
        stages: Some(stages),
    }
}

/// The table of a stage type.
pub fn table<S: StageType + 'static>() -> abi::StageTable {
    let card: &'static Card = Box::leak(Box::new(S::type_card()));
    abi::StageTable {
        create: Some(create::<S>),
        describe: Some(describe::<S>),
        run: Some(run::<S>),
        destroy: Some(destroy::<S>),
        check: Some(check::<S>),
        ..card::table(card)
    }
}

unsafe extern "C" fn create<S: StageType>(
    arguments: Text,
    host: *const abi::Host,
    stage: *mut *mut c_void,
) -> i32 {
    entry(host, || {
        let arguments = unsafe { text(arguments) }.map_err(StageError::internal)?;
        let made = ron_options().from_str::<S>(arguments);
        let made = made.map_err(|e| StageError::new(ErrorCode::InvalidParameter, e.code.to_string()))?;
        unsafe { stage.write(Box::into_raw(Box::new(made)).cast()) };
        Ok(())
    })
}

unsafe extern "C" fn describe<S: StageType>(stage: *const c_void, host: *const abi::Host) -> i32 {
    entry(host, || {
        let params = unsafe { &*stage.cast::<S>() }.params();
        if let Some(answer) = unsafe { (*host).answer } {
            unsafe { answer((*host).ctx, Text::of(&params)) };
        }
        Ok(())
    })
}

unsafe extern "C" fn run<S: StageType>(
    stage: *const c_void,
    host: *const abi::Host,
    call: *const abi::Call,
) -> i32 {
    entry(host, || {
        let (stage, host, call) = unsafe { (&*stage.cast::<S>(), *host, &*call) };
        let remote = Arc::new(Remote(RwLock::new(Some(host))));
        let outcome = run_stage(stage, call, &remote);
        // The stage may have kept its context: it must not call the host any more.
        *remote.0.write().unwrap_or_else(PoisonError::into_inner) = None;
        give_all(&host, outcome?)
    })
}

unsafe extern "C" fn destroy<S: StageType>(stage: *mut c_void) {
    let _ = guarded(|| {
        drop(unsafe { Box::from_raw(stage.cast::<S>()) });
        Ok(())
    });
}

unsafe extern "C" fn check<S: StageType>(
    param: usize,
    value: Text,
    host: *const abi::Host,
    offset: *mut i64,
) -> i32 {
    let mut refused = None;
    let status = entry(host, || {
        let value = unsafe { text(value) }.map_err(StageError::internal)?;
        let card = S::type_card();
        let doc = card.params.get(param).ok_or_else(|| StageError::internal("no such parameter"))?;
        refused = doc.check.run(value, doc).err();
        Ok(())
    });
    let Some(fault) = refused else { return status };
    if let Some(offset) = unsafe { offset.as_mut() } {
        *offset = fault.offset.map_or(-1, |o| o as i64);
    }
    tell(host, "bad_value", &fault.message, fault.hint.as_deref().unwrap_or(""), &fault.reason);
    abi::FAILED
}

/// Runs the body of an entry point, and passes its error or panic to the program.
fn entry(host: *const abi::Host, work: impl FnOnce() -> Result<(), StageError>) -> i32 {
    let failed = |e: &StageError| {
        tell(host, e.code.as_str(), &e.message, e.hint.as_deref().unwrap_or(""), e.param.unwrap_or(""));
        abi::FAILED
    };
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(())) => abi::OK,
        Ok(Err(e)) => failed(&e),
        Err(payload) => match payload.downcast_ref::<StageError>() {
            Some(e) => failed(e),
            None => {
                tell(host, "internal", &panics::words(payload), "", "");
                abi::PANICKED
            }
        },
    }
}

fn tell(host: *const abi::Host, code: &str, message: &str, hint: &str, about: &str) {
    let Some(host) = (unsafe { host.as_ref() }) else { return };
    if let Some(fail) = host.fail {
        unsafe { fail(host.ctx, Text::of(code), Text::of(message), Text::of(hint), Text::of(about)) };
    }
}

fn run_stage<S: StageType>(
    stage: &S,
    call: &abi::Call,
    remote: &Arc<Remote>,
) -> Result<Vec<PortValue>, StageError> {
    let inputs = unsafe { inputs(call, &S::type_card()) }.map_err(StageError::internal)?;
    let words = |t| unsafe { text(t) }.map_err(StageError::internal);
    let (id, own, base) = (words(call.stage)?, words(call.entry)?, words(call.base)?);
    let (asked, listener) = (remote.clone(), remote.clone());
    let cancel = Cancel::asking(move || asked.cancelled());
    let cx = Context::new(id, Path::new(base), cancel, listener).with_parallel(remote.clone());
    let cx = if own.is_empty() { cx } else { cx.for_entry(own) };
    let made = on_threads(remote.threads(), || stage.run_ports(&inputs, &cx));
    for (path, digest) in cx.take_reads() {
        remote.reads(&path, digest.map(|d| d.0));
    }
    for figure in cx.take_figures() {
        remote.figure(&figure.name, figure.value, figure.unit);
    }
    made
}

/// Runs the work, which has no pool.
#[cfg(not(feature = "rayon"))]
fn on_threads<T: Send>(_: u32, work: impl FnOnce() -> T + Send) -> T {
    work()
}

/// Runs in a pool of as many threads as the user allows: a library has its own pool.
#[cfg(feature = "rayon")]
fn on_threads<T: Send>(threads: u32, work: impl FnOnce() -> T + Send) -> T {
    static POOLS: Mutex<BTreeMap<u32, Arc<rayon::ThreadPool>>> = Mutex::new(BTreeMap::new());
    static COMMON: std::sync::Once = std::sync::Once::new();
    // Colliders are called outside of any run: their loops run in the library's common pool.
    COMMON.call_once(|| {
        let _ = rayon::ThreadPoolBuilder::new().num_threads(threads as usize).build_global();
    });
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let pool = match pools.get(&threads) {
        Some(pool) => Ok(pool.clone()),
        None => rayon::ThreadPoolBuilder::new().num_threads(threads as usize).build().map(Arc::new),
    };
    if let Ok(pool) = &pool {
        pools.insert(threads, pool.clone());
    }
    drop(pools);
    match pool {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

/// The inputs of a call as artifacts.
unsafe fn inputs(call: &abi::Call, card: &Card) -> Result<Inputs, String> {
    use super::view::list;
    let fed = unsafe { list::<u32>(call.fed.cast(), call.ports as usize, "the ports")? };
    let given = unsafe { list::<abi::Input>(call.inputs.cast(), call.count, "the inputs")? };
    let empty = |(how, port): (&u32, &crate::InPort)| {
        (*how == abi::FED_SET).then(|| PortValue::Set(port.kind, BTreeMap::new()))
    };
    let mut ports: Vec<Option<PortValue>> = fed.iter().zip(&card.inputs).map(empty).collect();
    for input in given {
        let artifact = unsafe { artifact(input)? };
        let name = unsafe { text(input.name)? }.to_owned();
        match ports.get_mut(input.port as usize).ok_or("an input belongs to no port")? {
            Some(PortValue::Set(_, set)) => {
                set.insert(name, artifact);
            }
            port => *port = Some(PortValue::One(artifact)),
        }
    }
    Ok(Inputs(ports))
}

unsafe fn artifact(input: &abi::Input) -> Result<Arc<dyn Artifact>, String> {
    if !input.collider.is_null() {
        let collider = unsafe { collide::shared(input.collider, "the program")? };
        return Ok(Arc::new(collider));
    }
    let kind = kind_named(unsafe { text(input.kind)? }).ok_or("an input is of an unknown kind")?;
    let record = unsafe { record(input.record, &mut u64::MAX.clone())? };
    from_trusted_record(kind, &record)
}

/// Gives what a stage made to the program.
fn give_all(host: &abi::Host, made: Vec<PortValue>) -> Result<(), StageError> {
    for (port, value) in made.iter().enumerate() {
        for (name, artifact) in value.entries() {
            give(host, port as u32, name, artifact.as_ref())?;
        }
    }
    Ok(())
}

fn give(host: &abi::Host, port: u32, name: &str, artifact: &dyn Artifact) -> Result<(), StageError> {
    let any: &dyn Any = artifact;
    let status = match (any.downcast_ref::<Collider>(), artifact.record()) {
        (Some(collider), _) => {
            let lent = collide::lend(collider);
            host.give_collider.map(|give| unsafe { give(host.ctx, port, &lent) })
        }
        (None, Some(record)) => {
            let lent = Lent::of(record);
            host.give.map(|give| unsafe { give(host.ctx, port, Text::of(name), lent.as_ptr()) })
        }
        (None, None) => None,
    };
    match status {
        Some(abi::OK) => Ok(()),
        _ => Err(StageError::internal(format!("its {} was not taken", artifact.kind()))),
    }
}

/// The program, asked through the plugin ABI until the call is over.
struct Remote(RwLock<Option<abi::Host>>);

// The program's functions may be called from any thread.
unsafe impl Send for Remote {}
unsafe impl Sync for Remote {}

impl Remote {
    fn with<T>(&self, ask: impl FnOnce(&abi::Host) -> T) -> Option<T> {
        self.0.read().unwrap_or_else(PoisonError::into_inner).as_ref().map(ask)
    }

    fn threads(&self) -> u32 {
        self.with(|h| h.threads).unwrap_or(1)
    }

    fn cancelled(&self) -> bool {
        self.with(|h| h.cancelled.is_some_and(|ask| unsafe { ask(h.ctx) } != 0)).unwrap_or(true)
    }

    fn reads(&self, path: &str, digest: Option<[u8; 32]>) {
        let digest = digest.as_ref().map_or(std::ptr::null(), |d| d.as_ptr());
        self.with(|h| h.reads.map(|f| unsafe { f(h.ctx, Text::of(path), digest) }));
    }

    fn figure(&self, name: &str, value: f64, unit: &str) {
        self.with(|h| h.figure.map(|f| unsafe { f(h.ctx, Text::of(name), value, Text::of(unit)) }));
    }
}

/// The program's own way to take a note; none in programs before 1.2, whose structure ends before
/// it.
fn host_note(host: &abi::Host) -> Option<unsafe extern "C" fn(ctx: *mut c_void, text: Text)> {
    host.note.filter(|_| host.minor >= 2)
}

impl Listener for Remote {
    fn event(&self, _: &str, _: &str, event: &Event) {
        self.with(|h| match event {
            Event::Progress { share, text } => {
                if let Some(f) = h.progress {
                    unsafe { f(h.ctx, *share, Text::of(text)) };
                }
            }
            Event::Note(text) => {
                if let Some(f) = host_note(h).or(h.warn) {
                    unsafe { f(h.ctx, Text::of(text)) };
                }
            }
            Event::Warning(text) => {
                if let Some(f) = h.warn {
                    unsafe { f(h.ctx, Text::of(text)) };
                }
            }
        });
    }
}

impl Parallel for Remote {
    fn run(&self, count: usize, body: &(dyn Fn(usize) + Sync)) {
        let work = LoopBody { body, panicked: Mutex::new(None) };
        let served = self.with(|h| {
            h.parallel_for.map(|f| unsafe {
                f(h.ctx, count, std::ptr::from_ref(&work).cast_mut().cast(), Some(loop_body))
            })
        });
        if served.flatten().is_none() {
            (0..count).for_each(body);
        }
        let panicked = work.panicked.into_inner().unwrap_or_else(PoisonError::into_inner);
        if let Some(text) = panicked {
            std::panic::resume_unwind(Box::new(text));
        }
    }
}

/// A loop's body, and what it said when it panicked.
struct LoopBody<'a> {
    body: &'a (dyn Fn(usize) + Sync),
    panicked: Mutex<Option<String>>,
}

unsafe extern "C" fn loop_body(data: *mut c_void, index: usize) {
    let work = unsafe { &*data.cast::<LoopBody<'_>>() };
    if let Err(payload) = catch_unwind(AssertUnwindSafe(|| (work.body)(index))) {
        *work.panicked.lock().unwrap_or_else(PoisonError::into_inner) = Some(panics::words(payload));
    }
}

//! The types that cross the plugin ABI, as C has them (`core/include/toile_plugin.h`).
//!
//! Rules, given in full in docs/reference/plugin-abi.md: nothing but these types and plain numbers
//! crosses; fields are only ever added at the end of a structure, with a new minor version; the
//! side that passes memory keeps it until the call that passed it returns; neither side frees what
//! the other side made.

use std::ffi::c_void;

/// The first bytes of every declaration.
pub const MAGIC: [u8; 8] = *b"TOILEPLG";
/// Raised when a plugin built before can no longer be understood.
pub const MAJOR: u32 = 1;
/// Raised when fields are added. 1: `StageTable::check`, `Host::parallel_for`, `Host::reads`. 2:
/// `Host::note`.
pub const MINOR: u32 = 2;

/// What a call gives back: done.
pub const OK: i32 = 0;
/// Result of a call that could not do its work, and has given the reason through [`Host::fail`].
pub const FAILED: i32 = 1;
/// Result of a call that panicked, and has given the message through [`Host::fail`].
pub const PANICKED: i32 = 2;

/// UTF-8 text, not ended by a zero.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Text {
    /// Its first byte; may be null where `len` is 0.
    pub ptr: *const u8,
    /// Bytes.
    pub len: usize,
}

/// One field of a record.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// Its name.
    pub name: Text,
    /// Its numbers, the bytes of its text, or its [`Record`]s.
    pub data: *const c_void,
    /// How many numbers, bytes or records.
    pub count: usize,
    /// One of the `FIELD_` constants.
    pub kind: u32,
    /// Numbers in one element: 3 for points in space.
    pub width: u32,
    /// Who keeps the numbers beyond the call; null where they must be copied before it returns.
    pub owner: *const Owner,
}

/// Keeps a list beyond the call that lent it.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Owner {
    /// Argument of `retain`.
    pub ctx: *mut c_void,
    /// Gives a handle that keeps the list where it is, unchanged, until `release`; null where it
    /// cannot.
    pub retain: Option<unsafe extern "C" fn(ctx: *mut c_void) -> *mut c_void>,
    /// Ends a handle; may be called from any thread.
    pub release: Option<unsafe extern "C" fn(handle: *mut c_void)>,
}

/// `uint8_t`.
pub const FIELD_U8: u32 = 1;
/// `uint32_t`.
pub const FIELD_U32: u32 = 2;
/// `uint64_t`.
pub const FIELD_U64: u32 = 3;
/// `float`.
pub const FIELD_F32: u32 = 4;
/// `double`.
pub const FIELD_F64: u32 = 5;
/// UTF-8 text.
pub const FIELD_TEXT: u32 = 6;
/// Further records.
pub const FIELD_RECORDS: u32 = 7;

/// An artifact, or a part of one, as named fields.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Record {
    /// Its fields.
    pub fields: *const Field,
    /// How many.
    pub count: usize,
}

/// An input or output port.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Port {
    /// The argument's name; empty for an output.
    pub name: Text,
    /// `photo`, `mask`, `outline`, `panel`, `body`, `collider`, `garment`, ...
    pub kind: Text,
    /// One of the `ARITY_` constants.
    pub arity: u32,
    /// `PORT_OPTIONAL`, `PORT_ORIGINAL`.
    pub flags: u32,
}

/// A single value.
pub const ARITY_ONE: u32 = 0;
/// One value of a named set at a time.
pub const ARITY_EACH: u32 = 1;
/// The whole named set.
pub const ARITY_ALL: u32 = 2;
/// The stage can do without.
pub const PORT_OPTIONAL: u32 = 1;
/// It takes the first made of its kind.
pub const PORT_ORIGINAL: u32 = 2;

/// A parameter.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Param {
    /// Its name.
    pub name: Text,
    /// What it does.
    pub doc: Text,
    /// Its type in words: `number`, `whole number`, `length`, `true | false`, `text`,
    /// `Four | Eight`, ...
    pub kind: Text,
    /// Its unit; may be empty.
    pub unit: Text,
    /// Its default as RON.
    pub default: Text,
    /// Its least value (lengths in metres); not a number where it has none.
    pub min: f64,
    /// Its greatest value.
    pub max: f64,
    /// `PARAM_TRADES`, `PARAM_FINER_LESS` or `PARAM_FINER_MORE`, and `PARAM_WAY`; a host leaves
    /// bits alone that it does not know.
    pub flags: u32,
    /// Zero.
    pub reserved: u32,
}

/// The parameter trades accuracy for time.
pub const PARAM_TRADES: u32 = 1;
/// It is a resolution, and less is finer.
pub const PARAM_FINER_LESS: u32 = 2;
/// It is a resolution, and more is finer.
pub const PARAM_FINER_MORE: u32 = 4;
/// A value other than the default makes the stage do different work, whose cost is recorded
/// separately.
pub const PARAM_WAY: u32 = 8;

/// One artifact that a stage is given.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Input {
    /// The port it belongs to, an index into the stage's inputs.
    pub port: u32,
    /// Zero.
    pub reserved: u32,
    /// Its kind: `photo`, `mask`, ...
    pub kind: Text,
    /// Its name in a named set (`front`); empty for a single value.
    pub name: Text,
    /// The artifact; null for a service.
    pub record: *const Record,
    /// The collider; null for an artifact.
    pub collider: *const Collider,
}

/// Nothing feeds the port.
pub const FED_NOTHING: u32 = 0;
/// A single value feeds the port.
pub const FED_ONE: u32 = 1;
/// A named set feeds the port.
pub const FED_SET: u32 = 2;

/// What a stage is to work on.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Call {
    /// Bytes of this structure.
    pub size: u32,
    /// How many ports there are in `fed`.
    pub ports: u32,
    /// For every input port one of the `FED_` constants.
    pub fed: *const u32,
    /// The artifacts, in the order of their ports and names.
    pub inputs: *const Input,
    /// How many.
    pub count: usize,
    /// The stage's id in the pipeline.
    pub stage: Text,
    /// The entry of the named set at work; empty for a stage that is not mapped.
    pub entry: Text,
    /// The folder that paths in the pipeline are relative to.
    pub base: Text,
}

/// What the program offers to a plugin during a call. Every function may be called from any thread
/// until the call returns.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Host {
    /// Bytes of this structure.
    pub size: u32,
    /// The program's ABI.
    pub major: u32,
    /// The program's ABI.
    pub minor: u32,
    /// How many threads the user allows.
    pub threads: u32,
    /// First argument of all functions below.
    pub ctx: *mut c_void,
    /// Memory for an output, 16-byte aligned and zero; the program frees it after the call. Null
    /// where the limit is passed: give back `FAILED` then.
    pub alloc: Option<unsafe extern "C" fn(ctx: *mut c_void, bytes: usize) -> *mut c_void>,
    /// Gives an artifact to an output port, under a name where the port is a set. The program has
    /// its own copy when this returns. Anything but `OK`: give back `FAILED`.
    pub give:
        Option<unsafe extern "C" fn(ctx: *mut c_void, port: u32, name: Text, record: *const Record) -> i32>,
    /// Gives a collider to an output port. The program calls its `destroy` once it needs it no
    /// more, also where this does not give back `OK`.
    pub give_collider:
        Option<unsafe extern "C" fn(ctx: *mut c_void, port: u32, collider: *const Collider) -> i32>,
    /// Answers a question for a text, such as [`StageTable::params`].
    pub answer: Option<unsafe extern "C" fn(ctx: *mut c_void, text: Text)>,
    /// Gives the reason why a call fails: code (`invalid_input`, ...), one sentence in lower case,
    /// a hint (may be empty), and the parameter at fault (may be empty; of a check, the reason
    /// without the parameter's name).
    pub fail:
        Option<unsafe extern "C" fn(ctx: *mut c_void, code: Text, message: Text, hint: Text, about: Text)>,
    /// Warns of something that the user should look at; the warning is also in the report.
    pub warn: Option<unsafe extern "C" fn(ctx: *mut c_void, text: Text)>,
    /// Reports the share of the work that is done, 0 to 1, and what it is doing.
    pub progress: Option<unsafe extern "C" fn(ctx: *mut c_void, share: f64, text: Text)>,
    /// Keeps a figure for report and metrics.
    pub figure: Option<unsafe extern "C" fn(ctx: *mut c_void, name: Text, value: f64, unit: Text)>,
    /// Not zero once the user has asked to stop. Ask at least every 50 ms.
    pub cancelled: Option<unsafe extern "C" fn(ctx: *mut c_void) -> u8>,
    /// Since 1.1. Calls `body(data, i)` for every `i` below `count`, on the program's threads, in
    /// any order, and returns when all are done.
    pub parallel_for: Option<
        unsafe extern "C" fn(
            ctx: *mut c_void,
            count: usize,
            data: *mut c_void,
            body: Option<unsafe extern "C" fn(data: *mut c_void, index: usize)>,
        ),
    >,
    /// Since 1.1. Reports that a file was read, so that the stage runs again when it has changed:
    /// its path as the pipeline names it, and the BLAKE3 digest of its content, 32 bytes, or null:
    /// then the program reads the file itself.
    pub reads: Option<unsafe extern "C" fn(ctx: *mut c_void, path: Text, digest: *const u8)>,
    /// Since 1.2. Reports a decision, shown with `--verbose`; it is also in the report.
    pub note: Option<unsafe extern "C" fn(ctx: *mut c_void, text: Text)>,
}

/// A stage type.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct StageTable {
    /// The version of its algorithm.
    pub version: u32,
    /// Zero.
    pub reserved: u32,
    /// Its name in pipeline files.
    pub name: Text,
    /// `denoiser`, `binariser`, `edge detector`, `mesher`, `smoother`, `collider`, `stitcher`,
    /// `texturer`, ...
    pub role: Text,
    /// Its user page.
    pub doc: Text,
    /// The method's author and year.
    pub source: Text,
    /// An example as it stands in a pipeline file.
    pub example: Text,
    /// What it promises: `deterministic`, `thread_invariant`, ...
    pub contracts: *const Text,
    /// How many.
    pub contract_count: usize,
    /// Its parameters.
    pub params: *const Param,
    /// How many.
    pub param_count: usize,
    /// Its input ports.
    pub inputs: *const Port,
    /// How many.
    pub input_count: usize,
    /// Its output ports.
    pub outputs: *const Port,
    /// How many.
    pub output_count: usize,
    /// Makes a stage from its arguments as RON, `(bias: 3.0)`.
    pub create:
        Option<unsafe extern "C" fn(arguments: Text, host: *const Host, stage: *mut *mut c_void) -> i32>,
    /// Answers with all its parameters as RON.
    pub describe: Option<unsafe extern "C" fn(stage: *const c_void, host: *const Host) -> i32>,
    /// Runs it. May be called on several threads at once.
    pub run: Option<unsafe extern "C" fn(stage: *const c_void, host: *const Host, call: *const Call) -> i32>,
    /// Frees it.
    pub destroy: Option<unsafe extern "C" fn(stage: *mut c_void)>,
    /// Since 1.1, may be null. Checks a RON text as the value of a parameter; gives the byte at
    /// fault, or -1, through `offset`.
    pub check:
        Option<unsafe extern "C" fn(param: usize, text: Text, host: *const Host, offset: *mut i64) -> i32>,
}

/// What a library exports under the name `toile_plugin`, or `toile_plugin_` and a name of its own.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Declaration {
    /// [`MAGIC`].
    pub magic: [u8; 8],
    /// The ABI that it was built for.
    pub major: u32,
    /// The ABI that it was built for.
    pub minor: u32,
    /// Bytes of this structure.
    pub size: u32,
    /// Bytes from one stage table to the next.
    pub stage_size: u32,
    /// Bytes from one parameter to the next.
    pub param_size: u32,
    /// Bytes from one port to the next.
    pub port_size: u32,
    /// The plugin's name.
    pub name: Text,
    /// Its version.
    pub version: Text,
    /// Gives its stage tables, which stay for as long as the library is loaded.
    pub stages: Option<unsafe extern "C" fn(count: *mut usize) -> *const c_void>,
}

/// Bytes of [`StageTable`] in ABI 1.0: all before `check`.
pub const STAGE_SIZE_1_0: u32 = std::mem::offset_of!(StageTable, check) as u32;
/// Bytes of [`Host`] in ABI 1.0: all before `parallel_for`.
pub const HOST_SIZE_1_0: u32 = std::mem::offset_of!(Host, parallel_for) as u32;

/// A list of results in the asker's memory.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Sink {
    /// First argument of `grow`.
    pub ctx: *mut c_void,
    /// Room for so many further results, to be filled before the next call; null where there is
    /// none.
    pub grow: Option<unsafe extern "C" fn(ctx: *mut c_void, count: usize) -> *mut c_void>,
}

/// A list of points and triangles: three coordinates per point, metres; three indices per triangle.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Cloth {
    /// Coordinates.
    pub positions: *const f64,
    /// Points.
    pub points: usize,
    /// Indices; null where none are asked about.
    pub triangles: *const u32,
    /// Triangles.
    pub triangle_count: usize,
}

/// The settings of a collider.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct ColliderCard {
    /// Metres.
    pub thickness: f64,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// 0 to 1.
    pub restitution: f64,
    /// The coefficient of the force that pushes cloth off the body; not a number where contacts
    /// are resolved by impulses.
    pub penalty: f64,
    /// Not zero where cloth against itself is looked for.
    pub self_collision: u32,
    /// 0 for a force in proportion to how much nearer than the thickness cloth is, N/m; 1 for one
    /// that falls with exp(-distance / thickness), N.
    pub penalty_law: u32,
}

/// A collision scheme, called in the solvers' inner loops, from any thread and from several at
/// once.
///
/// The functions give back `OK`, or anything else where they failed; `why` then gives the reason.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ColliderTable {
    /// Bytes of this structure.
    pub size: u32,
    /// Zero.
    pub reserved: u32,
    /// Its settings.
    pub card: Option<unsafe extern "C" fn(this: *const c_void, card: *mut ColliderCard) -> i32>,
    /// Fills the sink with `toile_body_contact`.
    pub body_contacts: Option<
        unsafe extern "C" fn(this: *const c_void, cloth: *const Cloth, reach: f64, sink: *const Sink) -> i32,
    >,
    /// Paths from the first points to the second; fills the sink with `toile_body_contact`.
    pub body_hits: Option<
        unsafe extern "C" fn(
            this: *const c_void,
            from: *const Cloth,
            to: *const Cloth,
            sink: *const Sink,
        ) -> i32,
    >,
    /// Fills the sink with `toile_self_contact`.
    pub self_contacts: Option<
        unsafe extern "C" fn(this: *const c_void, cloth: *const Cloth, reach: f64, sink: *const Sink) -> i32,
    >,
    /// Writes one bound for each point.
    pub conservative_bounds: Option<
        unsafe extern "C" fn(this: *const c_void, cloth: *const Cloth, reach: f64, bounds: *mut f64) -> i32,
    >,
    /// Fills the sink with pairs of triangle indices (`uint32_t[2]`).
    pub self_crossings:
        Option<unsafe extern "C" fn(this: *const c_void, cloth: *const Cloth, sink: *const Sink) -> i32>,
    /// Makes a second handle of the same collider, with a `destroy` of its own, so that it may be
    /// kept beyond the call. Colliders of the program have it; of a plugin it may be null.
    pub share: Option<unsafe extern "C" fn(this: *const c_void, collider: *mut Collider) -> i32>,
    /// Why the last call on this thread failed, good until the next one; may be null.
    pub why: Option<unsafe extern "C" fn(this: *const c_void) -> Text>,
    /// Frees it.
    pub destroy: Option<unsafe extern "C" fn(this: *mut c_void)>,
}

/// A collision scheme made for one body.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Collider {
    /// Its functions, which stay for as long as the collider lives.
    pub table: *const ColliderTable,
    /// Their first argument.
    pub this: *mut c_void,
    /// A text that names scheme and settings.
    pub signature: Text,
}

impl Text {
    /// The empty text.
    pub const EMPTY: Text = Text { ptr: std::ptr::null(), len: 0 };

    /// A view of a text, good for as long as the text is.
    pub const fn of(text: &str) -> Self {
        Text { ptr: text.as_ptr(), len: text.len() }
    }
}

// The tables are read only.
unsafe impl Sync for Declaration {}
unsafe impl Send for Declaration {}
unsafe impl Sync for StageTable {}
unsafe impl Send for StageTable {}
unsafe impl Sync for ColliderTable {}
unsafe impl Send for ColliderTable {}

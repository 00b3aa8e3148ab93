//! What a running stage may ask of the outside world.

use crate::artifact::{ArtifactType, Digest, Digester, Measure, Point3};
use crate::files::MAX_FILE_BYTES;
use crate::{ErrorCode, PortValue, Remarks, StageError, parallel};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A flag that asks everything to stop.
#[derive(Clone, Default)]
pub struct Cancel {
    flag: Arc<AtomicBool>,
    /// A second flag that is checked as well: that of the program, in a plugin.
    also: Option<Arc<dyn Fn() -> bool + Send + Sync>>,
}

impl std::fmt::Debug for Cancel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Cancel({})", self.is_cancelled())
    }
}

impl Cancel {
    /// Not cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks to stop.
    pub fn cancel(&self) {
        self.flag.store(true, Ordering::Relaxed);
    }

    /// True once asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.flag.load(Ordering::Relaxed) || self.also.as_ref().is_some_and(|ask| ask())
    }

    /// A flag that is also up where `ask` says so.
    pub(crate) fn asking(ask: impl Fn() -> bool + Send + Sync + 'static) -> Self {
        Cancel { flag: Arc::default(), also: Some(Arc::new(ask)) }
    }
}

/// What a stage reports while it works.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// How far the stage has come, 0 to 1, and what it is doing.
    Progress {
        /// Share done.
        share: f64,
        /// What it is doing: `seam gap 3.2 mm, energy 0.41 J`.
        text: String,
    },
    /// A decision and the fact behind it.
    Note(String),
    /// Something that the user should look at.
    Warning(String),
}

/// Receives a run's events. Called from any thread.
pub trait Listener: Send + Sync {
    /// Takes an event of the stage `stage` (`entry` of a named set).
    fn event(&self, stage: &str, entry: &str, event: &Event);

    /// Whether it wants to see now where a garment has come to. Asked after every step of a solver.
    fn looks_on(&self) -> bool {
        false
    }

    /// Takes the places of all vertices of the garment that the stage `stage` works on, metres.
    fn moves(&self, stage: &str, positions: Vec<Point3>) {
        let _ = (stage, positions);
    }
}

/// A listener that takes no notice.
impl Listener for () {
    fn event(&self, _: &str, _: &str, _: &Event) {}
}

/// Runs the parts of a loop elsewhere than in the present thread pool.
pub(crate) trait Parallel: Send + Sync {
    /// Calls `body(i)` for every `i` below `count`, in any order; returns when all are done.
    fn run(&self, count: usize, body: &(dyn Fn(usize) + Sync));
}

/// Makes a part of a stage's work.
pub type MakePart<'a> = Box<dyn FnOnce() -> Result<Vec<u8>, StageError> + 'a>;

/// Keeps parts of a stage's work beyond the run.
pub trait Memo: Send + Sync {
    /// The part of the stage `id` under that key: as it was kept, else as it is made now.
    ///
    /// Errors: those of `make`, of which nothing is kept.
    fn part(&self, id: &str, key: &Digester, make: MakePart<'_>) -> Result<Vec<u8>, StageError>;
}

/// Handed to every run of a stage.
pub struct Context {
    stage: String,
    entry: String,
    base: PathBuf,
    cancel: Cancel,
    listener: Arc<dyn Listener>,
    figures: Mutex<Vec<Measure>>,
    remarks: Mutex<Remarks>,
    so_far: Mutex<Option<PortValue>>,
    reads: Mutex<Vec<(String, Option<Digest>)>>,
    parallel: Option<Arc<dyn Parallel>>,
    memo: Option<Arc<dyn Memo>>,
    work: Mutex<f64>,
    allowance: Option<f64>,
}

impl Context {
    /// A context for the stage `stage`, with files relative to `base`.
    pub fn new(stage: &str, base: &Path, cancel: Cancel, listener: Arc<dyn Listener>) -> Self {
        Context {
            stage: stage.to_owned(),
            entry: String::new(),
            base: base.to_owned(),
            cancel,
            listener,
            figures: Mutex::default(),
            remarks: Mutex::default(),
            so_far: Mutex::default(),
            reads: Mutex::default(),
            parallel: None,
            memo: None,
            work: Mutex::default(),
            allowance: None,
        }
    }

    /// The same context with loops that run elsewhere.
    pub(crate) fn with_parallel(self, parallel: Arc<dyn Parallel>) -> Self {
        Context { parallel: Some(parallel), ..self }
    }

    /// The same context with a place for [`Context::memo`].
    pub fn with_memo(self, memo: Option<Arc<dyn Memo>>) -> Self {
        Context { memo, ..self }
    }

    /// The same context for a stage that may take so much [`Context::work`]; any amount for none.
    pub fn with_allowance(self, allowance: Option<f64>) -> Self {
        Context { allowance, ..self }
    }

    /// Counts work that was done: 1 for a step over all vertices of the garment. A stage that only
    /// improves on a result may take as much as that result took; beyond, [`Context::check`] errs.
    /// Steps count, not seconds: a result does not depend on the machine.
    pub fn work(&self, steps: f64) {
        *self.work.lock().unwrap_or_else(PoisonError::into_inner) += steps;
    }

    /// The work counted so far.
    pub fn work_so_far(&self) -> f64 {
        *self.work.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A part of the stage's work that depends on nothing but what `key` was fed: from the run's
    /// cache where an earlier run made it, else made by `make` and kept. For parts that outlive a
    /// change of the others, such as the light on a garment whose texture is edited.
    ///
    /// Errors: those of `make`, such as that of a stop; then nothing is kept.
    pub fn memo(
        &self,
        key: &Digester,
        make: impl FnOnce() -> Result<Vec<u8>, StageError>,
    ) -> Result<Vec<u8>, StageError> {
        match &self.memo {
            Some(memo) => memo.part(&self.stage, key, Box::new(make)),
            None => make(),
        }
    }

    /// Calls `body(i)` for every `i` below `count` on the threads that the user allows, in any
    /// order, and returns when all are done. Inside a plugin these are the program's threads.
    pub fn parallel_for(&self, count: usize, body: impl Fn(usize) + Sync) {
        match &self.parallel {
            Some(parallel) => parallel.run(count, &body),
            None => parallel::each(count, &body),
        }
    }

    /// `work(i)` of every `i` below `count`, made in parallel, in their order.
    pub fn parallel_map<T: Send>(&self, count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
        parallel::map(count, |count, body| self.parallel_for(count, body), work)
    }

    /// The stage's id in the pipeline.
    pub fn stage(&self) -> &str {
        &self.stage
    }

    /// The folder that paths in the pipeline are relative to.
    pub fn base(&self) -> &Path {
        &self.base
    }

    /// A context for tests: no listener, files relative to the current folder.
    pub fn quiet() -> Self {
        Context::new("test", Path::new("."), Cancel::new(), Arc::new(()))
    }

    /// The same context for one entry of a named set.
    pub fn for_entry(&self, entry: &str) -> Self {
        Context {
            entry: entry.to_owned(),
            parallel: self.parallel.clone(),
            memo: self.memo.clone(),
            allowance: self.allowance,
            ..Context::new(&self.stage, &self.base, self.cancel.clone(), self.listener.clone())
        }
    }

    /// The entry of the named set at work (`"front"`), empty for a stage that is not mapped.
    pub fn entry(&self) -> &str {
        &self.entry
    }

    /// Errs once the user has asked to stop, or the stage has taken more work than it may. Call it
    /// at least every 50 ms.
    pub fn check(&self) -> Result<(), StageError> {
        if self.cancel.is_cancelled() {
            return Err(StageError::new(ErrorCode::Cancelled, "stopped on request"));
        }
        match self.allowance {
            Some(allowance) if self.work_so_far() > allowance => Err(StageError::new(
                ErrorCode::Timeout,
                format!("it was not done after {allowance:.0} steps, as many as the garment before it took"),
            )),
            _ => Ok(()),
        }
    }

    /// The stop flag, for loops that cannot return early.
    pub fn cancel(&self) -> &Cancel {
        &self.cancel
    }

    /// Reports how far the stage has come: the share done, 0 to 1, and what it is doing.
    pub fn progress(&self, share: f64, text: impl Into<String>) {
        let event = Event::Progress { share: share.clamp(0.0, 1.0), text: text.into() };
        self.listener.event(&self.stage, &self.entry, &event);
    }

    /// Shows where the garment has come to, to those who look on: the places of its vertices,
    /// metres, in their order. `make` is called where somebody does.
    pub fn moves(&self, make: impl FnOnce() -> Vec<Point3>) {
        if self.listener.looks_on() {
            self.listener.moves(&self.stage, make());
        }
    }

    /// Reports a decision and the fact behind it: "the front is taken for a T-shirt". The note is
    /// in the report, and in the terminal with `--verbose`.
    pub fn note(&self, text: impl Into<String>) {
        let text = text.into();
        self.listener.event(&self.stage, &self.entry, &Event::Note(text.clone()));
        self.remarks().notes.push(text);
    }

    /// Warns of something that the user should look at. The warning is in the terminal and in the
    /// report.
    pub fn warn(&self, text: impl Into<String>) {
        let text = text.into();
        self.listener.event(&self.stage, &self.entry, &Event::Warning(text.clone()));
        self.remarks().warnings.push(text);
    }

    fn remarks(&self) -> MutexGuard<'_, Remarks> {
        self.remarks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Keeps what the stage has come to, for a look should it fail: a garment with an open seam,
    /// the mask of a photo that is refused. The last one counts.
    pub fn so_far(&self, artifact: impl ArtifactType) {
        self.take_over(Some(PortValue::One(Arc::new(artifact))));
    }

    /// Keeps what another context was given, where it was given something.
    pub fn take_over(&self, artifact: Option<PortValue>) {
        if artifact.is_some() {
            *self.so_far.lock().unwrap_or_else(PoisonError::into_inner) = artifact;
        }
    }

    /// What the stage has come to.
    pub fn take_so_far(&self) -> Option<PortValue> {
        self.so_far.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Keeps a figure for report and metrics: `figure("threshold", 131.0, "grey levels")`.
    pub fn figure(&self, name: &str, value: f64, unit: &'static str) {
        let measure = Measure { name: name.to_owned(), value, unit, tolerance: 0.0 };
        self.figures.lock().unwrap_or_else(PoisonError::into_inner).push(measure);
    }

    /// A path of the pipeline file, which is relative to that file.
    pub fn resolve(&self, path: &str) -> PathBuf {
        self.base.join(path)
    }

    /// Reads a file named by the pipeline.
    ///
    /// The run's cache keeps note of it: a stage whose file has changed runs again.
    pub fn read(&self, path: &str) -> Result<Vec<u8>, StageError> {
        let content = self.read_file(path);
        let hash = content.as_ref().ok().and_then(|bytes| digest_of(bytes));
        self.reads.lock().unwrap_or_else(PoisonError::into_inner).push((path.to_owned(), hash));
        content
    }

    /// Checks that a file named by the pipeline can be read, without reading it.
    ///
    /// Errors: those of [`Context::read`].
    pub fn look(&self, path: &str) -> Result<(), StageError> {
        let there = self
            .readable(path)
            .and_then(|full| std::fs::File::open(&full).map(|_| ()).map_err(|e| unread(path, &io_words(&e))));
        if there.is_err() {
            self.reads.lock().unwrap_or_else(PoisonError::into_inner).push((path.to_owned(), None));
        }
        there
    }

    /// Records a file that was read elsewhere; its content is hashed here if no digest is given.
    pub fn note_read(&self, path: &str, digest: Option<Digest>) {
        let digest = digest.or_else(|| digest_of(&crate::read_file(&self.resolve(path)).ok()?));
        self.reads.lock().unwrap_or_else(PoisonError::into_inner).push((path.to_owned(), digest));
    }

    fn read_file(&self, path: &str) -> Result<Vec<u8>, StageError> {
        crate::read_file(&self.resolve(path)).map_err(|e| unread(path, &io_words(&e)))
    }

    /// The full path of an ordinary file within the limit.
    fn readable(&self, path: &str) -> Result<PathBuf, StageError> {
        let full = self.resolve(path);
        let meta = crate::files::ordinary(&full).map_err(|e| match (e.kind(), near_file(path, &full)) {
            (std::io::ErrorKind::NotFound, Some(near)) => {
                unread(path, &io_words(&e)).hint(format!("did you mean \"{near}\"? {RELATIVE}"))
            }
            _ => unread(path, &io_words(&e)),
        })?;
        let size = meta.len();
        match size > MAX_FILE_BYTES {
            true => Err(unread(path, &format!("it has {size} bytes, the limit is {MAX_FILE_BYTES}"))),
            false => Ok(full),
        }
    }

    /// The files that the stage has read so far, with the digests of their contents; `None` for one
    /// that could not be read.
    pub fn take_reads(&self) -> Vec<(String, Option<Digest>)> {
        std::mem::take(&mut *self.reads.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Takes over the files that one entry of a set read.
    pub fn absorb_reads(&self, reads: &[(String, Option<Digest>)]) {
        self.reads.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(reads);
    }

    /// Takes over what one entry of a set noted, under the entry's name.
    pub fn absorb(&self, entry: &str, figures: Vec<Measure>, remarks: Remarks) {
        let named = figures.into_iter().map(|m| Measure { name: format!("{entry}.{}", m.name), ..m });
        self.figures.lock().unwrap_or_else(PoisonError::into_inner).extend(named);
        self.remarks().absorb(entry, remarks);
    }

    /// The figures given so far.
    pub fn take_figures(&self) -> Vec<Measure> {
        std::mem::take(&mut *self.figures.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The notes and warnings given so far.
    pub fn take_remarks(&self) -> Remarks {
        std::mem::take(&mut *self.remarks())
    }
}

/// The digest of a file's content.
#[cfg(feature = "digest")]
fn digest_of(bytes: &[u8]) -> Option<Digest> {
    Some(Digest::of(bytes))
}

/// A plugin without digests leaves it to the program to take that of the file.
#[cfg(not(feature = "digest"))]
fn digest_of(_: &[u8]) -> Option<Digest> {
    None
}

fn unread(path: &str, why: &str) -> StageError {
    StageError::new(ErrorCode::PatternLoading, format!("cannot read \"{path}\": {why}")).hint(RELATIVE)
}

const RELATIVE: &str = "paths are relative to the pipeline file";

/// The most files of a folder that are compared with a name.
const MAX_FILES: usize = 1000;

/// A file beside one that is not there, with a name so like it that it was probably meant: its path
/// as the pipeline would write it.
fn near_file(path: &str, full: &Path) -> Option<String> {
    let name = full.file_name()?.to_str()?;
    let files = std::fs::read_dir(full.parent()?).ok()?.take(MAX_FILES).flatten();
    let mut names: Vec<String> = files.filter_map(|f| f.file_name().into_string().ok()).collect();
    // A system lists its files in no order.
    names.sort();
    let near = crate::nearest(name, names.iter().map(String::as_str))?;
    let start = path.strip_suffix(name)?;
    Some(format!("{start}{near}"))
}

/// The system's reason without its number, so that it reads alike everywhere.
fn io_words(e: &std::io::Error) -> String {
    match e.kind() {
        std::io::ErrorKind::NotFound => "no such file".into(),
        std::io::ErrorKind::PermissionDenied => "permission denied".into(),
        _ => e.to_string(),
    }
}

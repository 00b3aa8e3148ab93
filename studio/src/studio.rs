//! The project joined to its runs: the answer to every request, without HTTP.

use crate::fault::StudioFault;
use crate::live::ask::{RunAsk, RunKind};
use crate::live::print::print;
use crate::live::read::ReadPattern;
use crate::live::shown::ShownArtifacts;
use crate::live::{LiveRuns, RunTools};
use crate::project::begin::BeginWith;
use crate::project::change::StudioChange;
use crate::project::{StudioProject, upload, written, written_file};
use crate::pulse::Pulse;
use crate::show::measures::measures;
use crate::show::trade::trade;
use crate::show::view::{FRONT, ViewText, view};
use crate::show::{mesh, pictures};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use toile_core::Registry;
use toile_core::artifact::{Garment, Model, Photo};
use toile_core::param::ron_text;
use toile_pattern::pattern::seams_file;
use toile_pattern::style::seen_styles;
use toile_pipeline::cache::Cache;

/// What a studio is opened with.
#[derive(Debug, Clone)]
pub struct StudioOptions {
    /// A pipeline file, or a folder.
    pub target: PathBuf,
    /// The stages.
    pub registry: Arc<Registry>,
    /// The cards of all stages, JSON, as `toile stages --json` prints them.
    pub cards: String,
    /// Where results of stages are kept.
    pub cache: Option<Arc<Cache>>,
    /// Threads of a run; as many as the machine has cores where none are named.
    pub threads: Option<usize>,
    /// Whether runs follow the edits.
    pub runs: bool,
}

/// A project that is worked on.
#[derive(Debug)]
pub struct Studio {
    folder: PathBuf,
    cards: String,
    project: Mutex<StudioProject>,
    live: LiveRuns,
    tools: RunTools,
    runs: bool,
    /// The quality of full runs.
    quality: Mutex<Option<String>>,
    /// The last garment that was packed.
    packed: Mutex<Option<PackedGarment>>,
    /// The last photo that a network has looked at, and what it saw.
    guessed: Mutex<Option<GuessedPhoto>>,
    pulse: Pulse,
}

/// A photo and the kinds that it may show, with their probabilities.
type GuessedPhoto = (Arc<Photo>, Vec<(&'static str, f64)>);

/// A garment as a file, and what it was made of.
#[derive(Debug)]
struct PackedGarment {
    garment: Arc<Garment>,
    model: Option<Arc<Model>>,
    bytes: Arc<Vec<u8>>,
}

fn held<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Studio {
    /// Opens a project and runs it, where it has a pipeline.
    ///
    /// Errors: another studio holds the folder; what the system says of its files.
    pub fn open(options: StudioOptions) -> Result<Self, StudioFault> {
        let StudioOptions { target, registry, cards, cache, threads, runs } = options;
        let project = StudioProject::open(&target, registry.clone())?;
        let tools = RunTools { registry, cache, threads };
        let pulse = Pulse::new();
        let studio = Studio {
            folder: project.folder().to_owned(),
            cards,
            project: Mutex::new(project),
            live: LiveRuns::new(tools.clone(), pulse.clone()),
            tools,
            runs,
            quality: Mutex::default(),
            packed: Mutex::default(),
            guessed: Mutex::default(),
            pulse,
        };
        studio.follow(&held(&studio.project));
        Ok(studio)
    }

    /// The state, with the text or without.
    pub fn state(&self, with_text: bool) -> Value {
        let project = held(&self.project);
        let checked = project.checked();
        let (stages, run, view, moving) = {
            let live = self.live.state();
            let moving = live.moving.is_some().then_some(live.moving_number);
            let stage = |line: &crate::project::text::StageLine| {
                let status = live.stages.get(&line.id).cloned().unwrap_or_default();
                joined(json!(line), json!(status))
            };
            (checked.stages.iter().map(stage).collect::<Vec<_>>(), live.run.json(), live.view, moving)
        };
        let mut state = json!({
            "project": {
                "folder": self.folder.display().to_string(),
                "file": project.file(),
                "edit": project.number(),
                "saved": project.is_saved(),
                "can_undo": project.can_undo(),
                "can_redo": project.can_redo(),
            },
            "faults": checked.faults,
            "stages": stages,
            "run": run,
            "view": view,
            "moving": moving,
        });
        if with_text {
            state["text"] = json!(project.text());
        }
        state
    }

    /// Edits the text; a run follows.
    ///
    /// Errors: those of [`StudioProject::edit`].
    pub fn edit(
        &self,
        edit: u64,
        words: &str,
        changes: &[StudioChange],
        draft: bool,
    ) -> Result<u64, StudioFault> {
        self.after(|project| project.edit(edit, words, changes, draft))
    }

    /// Takes the last edit back; a run follows.
    ///
    /// Errors: those of [`StudioProject::undo`].
    pub fn undo(&self, edit: u64) -> Result<u64, StudioFault> {
        self.after(|project| project.undo(edit))
    }

    /// Makes it again; a run follows.
    ///
    /// Errors: those of [`StudioProject::redo`].
    pub fn redo(&self, edit: u64) -> Result<u64, StudioFault> {
        self.after(|project| project.redo(edit))
    }

    /// Sews the proposed seams of these names: writes them into a file and gives it to the
    /// pattern's reader. A run follows.
    ///
    /// Errors: the reader takes no seams or has some; a name that is not proposed; those of
    /// [`StudioProject::edit`].
    pub(crate) fn sew(&self, edit: u64, words: &str, names: &[String]) -> Result<u64, StudioFault> {
        let none = || StudioFault::malformed("the pattern's file has its seams, or takes none");
        held(&self.project).checked().seams_to_give().ok_or_else(none)?;
        let read = self.shown().read;
        let proposed = read.as_deref().map(ReadPattern::proposed).unwrap_or_default();
        let find = |name: &String| {
            let found = proposed.iter().find(|p| p.seam.name == *name);
            found.ok_or_else(|| StudioFault::not_found(format!("there is no proposed seam \"{name}\"")))
        };
        let chosen = names.iter().map(find).collect::<Result<Vec<_>, _>>()?;
        if chosen.is_empty() {
            return Err(StudioFault::malformed("no seam is named"));
        }
        self.after(|project| {
            let path = project.checked().seams_to_give().ok_or_else(none)?;
            let file = upload(&self.folder, "seams.ron", seams_file(chosen.iter().copied()).as_bytes())?;
            project.edit(edit, words, &[StudioChange::Set { path, value: ron_text(&file) }], false)
        })
    }

    /// Writes the file; gives its name.
    ///
    /// Errors: those of [`StudioProject::save`].
    pub fn save(&self) -> Result<String, StudioFault> {
        let saved = held(&self.project).save();
        self.pulse.beat();
        saved
    }

    /// Begins a project; a run follows.
    pub(crate) fn begin(&self, with: &BeginWith) -> Result<u64, StudioFault> {
        self.after(|project| project.begin(with))
    }

    /// Does something to the project, after which its text is run.
    fn after(
        &self,
        act: impl FnOnce(&mut StudioProject) -> Result<u64, StudioFault>,
    ) -> Result<u64, StudioFault> {
        let mut project = held(&self.project);
        let number = act(&mut project)?;
        self.follow(&project);
        Ok(number)
    }

    /// Has a run follow the text.
    fn follow(&self, project: &StudioProject) {
        let kinds = vec![RunKind::Draft(None), RunKind::Full(held(&self.quality).clone())];
        let runs = self.runs && project.checked().runs();
        self.live.edited(ask(project, kinds).filter(|_| runs));
    }

    /// Runs the text now: a draft, or whole with its writers. Full runs keep the quality.
    pub(crate) fn run(&self, quality: Option<String>, full: bool) -> Result<(), StudioFault> {
        let project = held(&self.project);
        let checked = project.checked();
        if !checked.runs() {
            let fault = StudioFault::new("faults", "the text has faults");
            return Err(StudioFault { faults: checked.faults.clone(), ..fault });
        }
        let kind = match full {
            true => RunKind::Full(quality.clone()),
            false => RunKind::Draft(quality.clone()),
        };
        let ask = ask(&project, vec![kind]).ok_or_else(no_text)?;
        if let Some(name) = &quality {
            // Says which there are, where there is no such one.
            let changes = toile_pipeline::Changes { quality: Some(name), ..Default::default() };
            toile_pipeline::load_with(&ask.text, &ask.file, &ask.base, &self.tools.registry, &changes)?;
        }
        if full {
            *held(&self.quality) = quality;
        }
        self.live.run(ask);
        Ok(())
    }

    /// Stops the run under way.
    pub(crate) fn stop(&self) {
        self.live.stop();
    }

    /// The cards of all stages.
    pub(crate) fn cards(&self) -> &str {
        &self.cards
    }

    /// What runs have made so far.
    pub(crate) fn view(&self) -> Value {
        let checked = held(&self.project).checked();
        let (number, shown) = {
            let live = self.live.state();
            (live.view, live.shown())
        };
        let guesses = if checked.cuts_photos() { self.guesses(&shown) } else { Vec::new() };
        let text =
            ViewText { given: checked.landmarks(), proposes: checked.seams_to_give().is_some(), guesses };
        view(number, &shown, &text)
    }

    /// The kinds that a network sees in the photo of the front.
    fn guesses(&self, shown: &ShownArtifacts) -> Vec<(&'static str, f64)> {
        let Some(photo) = shown.photos.get(FRONT) else { return Vec::new() };
        let mut kept = held(&self.guessed);
        match kept.as_ref().filter(|(of, _)| Arc::ptr_eq(of, photo)) {
            Some((_, guesses)) => guesses.clone(),
            None => {
                // Without the network there are no guesses, and all kinds to choose from.
                let guesses = seen_styles(photo).unwrap_or_default();
                *kept = Some((photo.clone(), guesses.clone()));
                guesses
            }
        }
    }

    fn shown(&self) -> ShownArtifacts {
        self.live.state().shown()
    }

    pub(crate) fn photo(&self, name: &str) -> Result<(Vec<u8>, f64), StudioFault> {
        pictures::photo(&self.shown(), name)
    }

    pub(crate) fn mask(&self, name: &str) -> Result<Vec<u8>, StudioFault> {
        pictures::mask(&self.shown(), name)
    }

    pub(crate) fn texture(&self, n: usize) -> Result<Vec<u8>, StudioFault> {
        // A page asks for the pictures of the garment that it was given last.
        let shown = self.shown();
        let packed = held(&self.packed).as_ref().map(|packed| packed.model.clone());
        let model = packed.unwrap_or_else(|| shown.model.clone());
        pictures::texture(&ShownArtifacts { model, ..shown }, n)
    }

    /// The garment as a file.
    pub(crate) fn garment(&self) -> Result<Arc<Vec<u8>>, StudioFault> {
        let shown = self.shown();
        let none = || StudioFault::not_found("there is no garment yet");
        let garment = shown.garment.clone().ok_or_else(none)?;
        let same = |of: &PackedGarment| {
            let models = match (&of.model, &shown.model) {
                (Some(a), Some(b)) => Arc::ptr_eq(a, b),
                (a, b) => a.is_none() && b.is_none(),
            };
            models && Arc::ptr_eq(&of.garment, &garment)
        };
        if let Some(known) = held(&self.packed).as_ref().filter(|of| same(of)) {
            return Ok(known.bytes.clone());
        }
        let bytes = Arc::new(mesh::garment(&garment, &shown));
        *held(&self.packed) = Some(PackedGarment { garment, model: shown.model, bytes: bytes.clone() });
        Ok(bytes)
    }

    /// Where the vertices of the garment have come to while it is draped, as a file; of no vertices
    /// while none is: who asks is often a moment late.
    pub(crate) fn moving(&self) -> Vec<u8> {
        let moving = self.live.state().moving.clone();
        mesh::places(moving.as_deref().map_or(&[], Vec::as_slice))
    }

    /// The pieces around the body, before they are sewn, as a file.
    pub(crate) fn start(&self) -> Result<Vec<u8>, StudioFault> {
        let shown = self.shown();
        let none = || StudioFault::not_found("there are no pieces around the body yet");
        let start = shown.start.clone().ok_or_else(none)?;
        Ok(mesh::garment(&start, &ShownArtifacts { model: None, ..shown }))
    }

    /// The garment of the run before the last edit.
    pub(crate) fn before(&self) -> Result<Vec<u8>, StudioFault> {
        let (shown, before) = {
            let live = self.live.state();
            (live.shown(), live.before.clone())
        };
        let none = || StudioFault::not_found("there is no garment from before the last edit");
        Ok(mesh::garment(&*before.ok_or_else(none)?, &ShownArtifacts { model: None, ..shown }))
    }

    /// The body as a file.
    pub(crate) fn body(&self) -> Result<Vec<u8>, StudioFault> {
        let none = || StudioFault::not_found("there is no body yet");
        Ok(mesh::body(&*self.shown().body.ok_or_else(none)?))
    }

    /// Files that runs have written.
    pub(crate) fn written(&self) -> Value {
        json!({ "files": written(&self.folder) })
    }

    pub(crate) fn written_file(&self, path: &str) -> Result<Vec<u8>, StudioFault> {
        written_file(&self.folder, path)
    }

    /// Keeps a file in the project's folder; gives its name there.
    pub(crate) fn upload(&self, name: &str, bytes: &[u8]) -> Result<String, StudioFault> {
        upload(&self.folder, name, bytes)
    }

    /// The body's measures.
    pub(crate) fn measures(&self) -> Value {
        let checked = held(&self.project).checked();
        measures(checked.body.as_ref(), &self.shown())
    }

    /// Runs one writer of patterns; gives its files.
    pub(crate) fn print(&self, writer: &str) -> Result<Vec<String>, StudioFault> {
        let ask = ask(&held(&self.project), Vec::new()).ok_or_else(no_text)?;
        print(&ask, writer, &self.tools)
    }

    /// The qualities of the text.
    pub(crate) fn trade(&self) -> Result<Value, StudioFault> {
        let ask = ask(&held(&self.project), Vec::new()).ok_or_else(no_text)?;
        let chosen = held(&self.quality).clone();
        trade(&ask, chosen.as_deref(), &self.tools.registry)
    }

    /// The last note of progress, with its number.
    pub(crate) fn progress(&self) -> (u64, Option<Value>) {
        let live = self.live.state();
        (live.progress_number, live.progress.as_ref().map(|note| json!(note)))
    }

    /// Wakes those who wait for news.
    pub(crate) fn pulse(&self) -> &Pulse {
        &self.pulse
    }

    /// The folder of the project.
    pub fn folder(&self) -> &Path {
        &self.folder
    }
}

/// The project's text to run; none before there is one.
fn ask(project: &StudioProject, kinds: Vec<RunKind>) -> Option<RunAsk> {
    let file = project.file()?.to_owned();
    let (text, base) = (project.text().to_owned(), project.folder().to_owned());
    Some(RunAsk { text, edit: project.number(), file, base, kinds })
}

fn no_text() -> StudioFault {
    StudioFault::new("no_pipeline", "the project has no pipeline yet")
        .hint("begin with a photo, a pattern file or a sample")
}

/// Two objects as one.
fn joined(mut one: Value, other: Value) -> Value {
    if let (Value::Object(one), Value::Object(other)) = (&mut one, other) {
        one.extend(other);
    }
    one
}

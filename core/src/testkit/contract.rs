//! One check for each contract.

use super::suite::{cases, default_value, empty_value, has_empty, is_known, large_value};
use super::trial::{Trial, TrialOutcome};
use super::{Case, folder, motion, typed};
use crate::artifact::*;
use crate::{
    Arity, Cancel, Card, Contract, ErrorCode, InPort, Inputs, PortValue, Registry, Stage, StageType,
};
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// Numbers of threads that must give the same bits.
pub const THREADS: [usize; 3] = [1, 2, 5];
/// How soon a stage stops.
pub const PATIENCE: Duration = Duration::from_millis(50);
/// A machine that does other things as well may take this many times as long.
const NOISE: u32 = 4;
/// When a run is asked to stop: before it starts, and so many milliseconds into it.
const STOPS: [u64; 5] = [0, 15, 60, 200, 600];
/// A stop that came late is tried again, since noise only ever makes it later.
const TRIES: usize = 3;
/// A mesh's border may leave the outline by this share of its size: rounding.
const ON_OUTLINE: f64 = 1e-9;

/// How a contract was found kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kept {
    /// Cases run.
    pub cases: usize,
    /// Those that the stage did not refuse.
    pub answered: usize,
}

/// True where the kit can check that contract for a card: what its ports take, the suite holds.
pub fn is_checked(card: &Card, contract: Contract) -> bool {
    let known = card.inputs.iter().filter(|p| !p.optional).all(|p| is_known(p.kind));
    let kinds = |k: Kind| {
        card.inputs.iter().any(|p| p.kind == k) && card.outputs.iter().any(|p| p.kind == Panel::KIND)
    };
    let like = |(a, b): (&InPort, &crate::OutPort)| a.kind == b.kind && a.arity != Arity::All;
    known
        && match contract {
            Contract::Deterministic | Contract::ThreadInvariant | Contract::Cancellable => true,
            Contract::Improves => true,
            Contract::TranslationEquivariant | Contract::RotationEquivariant | Contract::ScaleEquivariant => {
                motion::of(contract).is_some_and(|m| motion::applies(card, m))
            }
            Contract::Idempotent => card.inputs.first().zip(card.outputs.first()).is_some_and(like),
            Contract::BoundaryPreserving => kinds(Outline::KIND) || kinds(Panel::KIND),
            Contract::RefusesEmpty => {
                card.inputs.is_empty() || card.inputs.iter().any(|p| !p.optional && has_empty(p.kind))
            }
        }
}

/// The contracts of a card that the kit checks.
pub fn checked(card: &Card) -> Vec<Contract> {
    card.contracts.iter().copied().filter(|c| is_checked(card, *c)).collect()
}

/// Checks a contract of a stage; `bare` is the stage as it is made without arguments.
///
/// Errors: the case, and how the contract is broken.
pub fn check(trial: Trial<'_>, bare: Option<&dyn Stage>, contract: Contract) -> Result<Kept, String> {
    let card = trial.stage.card();
    match contract {
        Contract::Deterministic => repeated(&trial, &cases(&card), |run| run()),
        Contract::ThreadInvariant => thread_invariant(&trial, &cases(&card)),
        Contract::TranslationEquivariant | Contract::RotationEquivariant | Contract::ScaleEquivariant => {
            equivariant(&trial, &card, contract)
        }
        Contract::Idempotent => idempotent(&trial, &cases(&card)),
        Contract::BoundaryPreserving => boundary_preserving(&trial, &cases(&card)),
        Contract::RefusesEmpty => refuses_empty(&trial, bare, &card),
        Contract::Cancellable => cancellable(&trial, &card),
        Contract::Improves => improves(&card),
    }
}

/// Holds a registered stage, as its example sets it, to one of its contracts.
///
/// Errors: the stage, the contract, the case and how it is broken.
pub fn check_registered(registry: &Registry, card: &Card, contract: Contract) -> Result<Kept, String> {
    let (_kept, path) = folder()?;
    let stage = super::from_example(registry, card, &path)?;
    let bare = registry.make(card, "()").ok();
    check(Trial { stage: stage.as_ref(), folder: &path }, bare.as_deref(), contract)
        .map_err(|e| broken(card, contract, &e))
}

fn broken(card: &Card, contract: Contract, why: &str) -> String {
    format!("{} ({}) does not keep {contract:?}: {why}", card.name, card.role.as_str())
}

/// What each test of [`contracts!`](crate::contracts) does.
///
/// # Panics
///
/// Where the stage breaks a contract that it promises.
#[allow(clippy::panic, clippy::print_stdout)]
pub fn assert_kept<S: StageType>(contract: Contract) {
    let (stage, card) = (S::default(), S::type_card());
    if !card.contracts.contains(&contract) {
        println!("{} does not promise {contract:?}", card.name);
        return;
    }
    if !is_checked(&card, contract) {
        println!("{} promises {contract:?}, which the suite cannot check for what it takes", card.name);
        return;
    }
    let kept = folder().and_then(|(_kept, path)| {
        super::files::files_for(&Registry::new(), card.example, &path)?;
        check(Trial { stage: &stage, folder: &path }, Some(&stage), contract)
    });
    match kept {
        Ok(kept) => println!("{contract:?}: {} cases, {} answered", kept.cases, kept.answered),
        Err(e) => panic!("{}", broken(&card, contract, &e)),
    }
}

/// Counts what was answered, and refuses a check that nothing came through.
fn tally(outcomes: &[(String, TrialOutcome)]) -> Result<Kept, String> {
    let answered = outcomes.iter().filter(|(_, o)| o.answered()).count();
    match outcomes.first() {
        Some((case, first)) if answered == 0 => {
            Err(format!("no case of the suite was answered; {case}: {}", first.fingerprint()))
        }
        _ => Ok(Kept { cases: outcomes.len(), answered }),
    }
}

/// Runs a case; a broken outcome is a fault whatever the contract.
fn run(trial: &Trial<'_>, case: &Case) -> Result<TrialOutcome, String> {
    match trial.run(&case.inputs) {
        TrialOutcome::Broken(fault) => Err(format!("on {}, {fault}", case.name)),
        outcome => Ok(outcome),
    }
}

/// Runs every case twice, the second time as `again` does it, and compares bits.
fn repeated(
    trial: &Trial<'_>,
    cases: &[Case],
    again: impl Fn(&(dyn Fn() -> TrialOutcome + Sync)) -> TrialOutcome,
) -> Result<Kept, String> {
    let mut outcomes = Vec::new();
    for case in cases {
        let first = run(trial, case)?;
        let second = again(&|| trial.run(&case.inputs));
        let (a, b) = (first.fingerprint(), second.fingerprint());
        if a != b {
            return Err(format!("on {} it gives {a}, then {b}", case.name));
        }
        outcomes.push((case.name.clone(), first));
    }
    tally(&outcomes)
}

fn thread_invariant(trial: &Trial<'_>, cases: &[Case]) -> Result<Kept, String> {
    let mut outcomes = Vec::new();
    for case in cases {
        let mut first: Option<(usize, TrialOutcome)> = None;
        for threads in THREADS {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|e| e.to_string())?;
            let outcome = pool.install(|| run(trial, case))?;
            match &first {
                None => first = Some((threads, outcome)),
                Some((n, f)) if f.fingerprint() != outcome.fingerprint() => {
                    let (a, b) = (f.fingerprint(), outcome.fingerprint());
                    return Err(format!(
                        "on {} it gives {a} with {n} threads, {b} with {threads}",
                        case.name
                    ));
                }
                Some(_) => {}
            }
        }
        outcomes.extend(first.map(|(_, o)| (case.name.clone(), o)));
    }
    tally(&outcomes)
}

fn equivariant(trial: &Trial<'_>, card: &Card, contract: Contract) -> Result<Kept, String> {
    let motion = motion::of(contract).filter(|m| motion::applies(card, *m));
    let motion = motion.ok_or("the kit cannot move what it takes, or compare what it gives")?;
    let pictures = card.inputs.iter().any(|p| p.kind == Photo::KIND || p.kind == Mask::KIND);
    let mut outcomes = Vec::new();
    for case in cases(card).into_iter().filter(|c| !c.hard) {
        let Some(moved) = motion::moved(&case.inputs, motion) else { continue };
        let (before, after) = (run(trial, &case)?, run(trial, &Case { inputs: moved, ..case.clone() })?);
        match (before.values(), after.values()) {
            (Some(a), Some(b)) => {
                motion::compare(a, b, motion, pictures).map_err(|e| format!("on {}, {e}", case.name))?;
            }
            (None, None) => {}
            _ => {
                let (a, b) = (before.fingerprint(), after.fingerprint());
                return Err(format!("on {} it gives {a}, and of the moved input {b}", case.name));
            }
        }
        outcomes.push((case.name, before));
    }
    tally(&outcomes)
}

fn idempotent(trial: &Trial<'_>, cases: &[Case]) -> Result<Kept, String> {
    let mut outcomes = Vec::new();
    for case in cases {
        let first = run(trial, case)?;
        if let Some(made) = first.values().and_then(|v| v.first()) {
            let mut inputs = case.inputs.clone();
            inputs.0[0] = Some(made.clone());
            let second = run(trial, &Case { inputs, ..case.clone() })?;
            if first.fingerprint() != second.fingerprint() {
                return Err(format!("on {} a second run changes what the first gave", case.name));
            }
        }
        outcomes.push((case.name.clone(), first));
    }
    tally(&outcomes)
}

fn boundary_preserving(trial: &Trial<'_>, cases: &[Case]) -> Result<Kept, String> {
    let mut outcomes = Vec::new();
    for case in cases {
        let outcome = run(trial, case)?;
        let made = outcome.values().unwrap_or(&[]);
        let panel = |(name, a)| Some((name, typed::<Panel>(a)?));
        let entries = made.iter().flat_map(PortValue::entries).map(|(name, a)| (name, a.as_ref()));
        for (name, panel) in entries.filter_map(panel) {
            let of = case.inputs.0.iter().flatten().flat_map(PortValue::entries);
            for (_, input) in of.filter(|(of, _)| *of == name) {
                let kept = match (typed::<Outline>(input.as_ref()), typed::<Panel>(input.as_ref())) {
                    (Some(outline), _) => on_outline(outline, panel),
                    (_, Some(before)) => same_boundary(before, panel),
                    _ => Ok(()),
                };
                kept.map_err(|e| format!("on {}, {e}", case.name))?;
            }
        }
        outcomes.push((case.name.clone(), outcome));
    }
    tally(&outcomes)
}

/// Boundary vertices lie on the outline, its corners are among them, named edges run between the
/// same points.
fn on_outline(outline: &Outline, panel: &Panel) -> Result<(), String> {
    let (low, high) = outline.bounds();
    let most = ON_OUTLINE * (high - low).norm();
    let loops: Vec<&Loop> = std::iter::once(&outline.outer).chain(&outline.holes).collect();
    let rims: Vec<&Vec<u32>> = std::iter::once(&panel.boundary).chain(&panel.holes).collect();
    if loops.len() != rims.len() {
        return Err(format!("an outline of {} loops became a mesh of {}", loops.len(), rims.len()));
    }
    let at = |v: &u32| panel.positions[*v as usize];
    for (l, rim) in loops.iter().zip(&rims) {
        let n = l.points.len();
        let side = |q: Point2, k: usize| motion::to_segment(q, l.points[k], l.points[(k + 1) % n]);
        for q in rim.iter().map(at) {
            let off = (0..n).map(|k| side(q, k)).fold(f64::INFINITY, f64::min);
            if off > most {
                return Err(format!("a vertex of the border is {:.6} mm off the outline", off * 1e3));
            }
        }
        for corner in l.corners.iter().map(|&c| l.points[c]) {
            if !rim.iter().any(|v| (at(v) - corner).norm() <= most) {
                return Err("a corner of the outline is no vertex of the border".into());
            }
        }
    }
    for edge in &outline.edges {
        let Some(made) = panel.edge(&edge.name) else {
            return Err(format!("the edge \"{}\" is lost", edge.name));
        };
        let ends = [(edge.start, made.vertices.first()), (edge.end, made.vertices.last())];
        let held =
            ends.iter().all(|(k, v)| v.is_some_and(|v| (at(v) - outline.outer.points[*k]).norm() <= most));
        if !held {
            return Err(format!("the edge \"{}\" does not end where it did", edge.name));
        }
    }
    Ok(())
}

/// Vertices on boundaries are where they were, bit for bit.
fn same_boundary(before: &Panel, after: &Panel) -> Result<(), String> {
    if before.boundary != after.boundary || before.holes != after.holes {
        return Err("the border runs through other vertices".into());
    }
    let rim = before.boundary.iter().chain(before.holes.iter().flatten());
    match rim.clone().position(|&v| before.positions[v as usize] != after.positions[v as usize]) {
        Some(k) => Err(format!("vertex {k} of the border moved")),
        None => Ok(()),
    }
}

fn refuses_empty(trial: &Trial<'_>, bare: Option<&dyn Stage>, card: &Card) -> Result<Kept, String> {
    let refused = |outcome: TrialOutcome, what: &str| match outcome {
        TrialOutcome::Refused(_, message) if !message.is_empty() => Ok(()),
        TrialOutcome::Refused(..) => Err(format!("it refuses {what} without a word")),
        TrialOutcome::Broken(fault) => Err(format!("given {what}, {fault}")),
        TrialOutcome::Answered(_) => Err(format!("it gives something of {what}")),
    };
    if card.inputs.is_empty() {
        let stage = bare.ok_or("it cannot be made without arguments")?;
        refused(Trial { stage, ..*trial }.run(&Inputs::default()), "no arguments")?;
        return Ok(Kept { cases: 1, answered: 0 });
    }
    let full: Vec<Option<PortValue>> = card.inputs.iter().map(default_value).collect();
    let mut cases = 0;
    for (k, port) in card.inputs.iter().enumerate().filter(|(_, p)| !p.optional) {
        let Some(empty) = empty_value(port) else { continue };
        let mut inputs = full.clone();
        inputs[k] = Some(empty);
        refused(trial.run(&Inputs(inputs)), &format!("an empty {}", port.kind))?;
        cases += 1;
    }
    Ok(Kept { cases, answered: 0 })
}

/// Looks whether the stage takes each kind that it makes, so that this can go on in the place of
/// its result.
fn improves(card: &Card) -> Result<Kept, String> {
    let takes = |out: &&crate::OutPort| card.inputs.iter().any(|p| p.kind == out.kind && !p.original);
    match card.outputs.iter().find(|out| !takes(out)) {
        Some(out) => Err(format!("it makes a {} and takes none", out.kind)),
        None => Ok(Kept { cases: card.outputs.len(), answered: card.outputs.len() }),
    }
}

/// Asks a run on large input to stop at several times, and looks how long it takes.
fn cancellable(trial: &Trial<'_>, card: &Card) -> Result<Kept, String> {
    let inputs = Inputs(card.inputs.iter().map(|p| large_value(card, p)).collect());
    for after in STOPS {
        let late = least_lateness(trial, &inputs, after)?;
        if late > PATIENCE * NOISE {
            return Err(format!(
                "it stopped {} ms after it was asked to, {after} ms into its run; {} ms are allowed",
                late.as_millis(),
                PATIENCE.as_millis()
            ));
        }
    }
    Ok(Kept { cases: STOPS.len(), answered: 0 })
}

/// The least of a few tries, none once one was in time.
fn least_lateness(trial: &Trial<'_>, inputs: &Inputs, after: u64) -> Result<Duration, String> {
    let mut least = Duration::MAX;
    for _ in 0..TRIES {
        least = least.min(lateness(trial, inputs, after)?.unwrap_or_default());
        if least <= PATIENCE {
            break;
        }
    }
    Ok(least)
}

/// How long a run went on after it was asked to stop; nothing where it was done before.
fn lateness(trial: &Trial<'_>, inputs: &Inputs, after: u64) -> Result<Option<Duration>, String> {
    let cancel = Cancel::new();
    let asked = cancel.clone();
    let (done, waiting) = mpsc::channel::<()>();
    let watch = std::thread::spawn(move || {
        let early = after > 0
            && waiting.recv_timeout(Duration::from_millis(after)) != Err(mpsc::RecvTimeoutError::Timeout);
        (!early).then(|| {
            asked.cancel();
            Instant::now()
        })
    });
    if after == 0 {
        cancel.cancel();
    }
    // Threads of its own: one that waits would else take up what other tests have to do, and be
    // late by that.
    let threads = rayon::current_num_threads();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|e| e.to_string())?;
    let outcome = pool.install(|| trial.run_until(inputs, cancel));
    let end = Instant::now();
    drop(done);
    let since = watch.join().map_err(|_| "the watch failed".to_owned())?;
    match outcome {
        TrialOutcome::Broken(fault) => Err(fault),
        TrialOutcome::Refused(code, message) if code != ErrorCode::Cancelled && since.is_none() => {
            Err(format!("the large case is refused: {message}"))
        }
        _ => Ok(since.map(|s| end.saturating_duration_since(s))),
    }
}

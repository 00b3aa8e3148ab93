//! Colliders across the plugin ABI, both ways: a collider of this side lent as a table of
//! functions, and a table of the other side behind [`Collide`].
//!
//! Positions and triangles cross as they lie in memory, results are written straight into the
//! asker's list; a call costs one indirect jump more than a collider that is linked in, and one
//! pass over its results, whose indices are checked.

use super::abi::{self, Cloth, Sink, Text};
use super::guard::{guarded, last_failure, meaning};
use super::inside::inside;
use super::view::{list, text};
use crate::artifact::{BodyContact, Collide, Collider, ColliderCard, Penalty, Point3, SelfContact};
use crate::{ErrorCode, StageError};
use std::ffi::c_void;
use std::sync::Arc;

/// The penalty laws as they cross.
const LINEAR: u32 = 0;
const EXPONENTIAL: u32 = 1;

/// A collider of this side as a table; the other side calls its `destroy`.
pub fn lend(collider: &Collider) -> abi::Collider {
    let this = Box::into_raw(Box::new(collider.clone()));
    // The text lies in the box, which stays where it is until `destroy`.
    let signature = Text::of(unsafe { &(*this).signature });
    abi::Collider { table: &TABLE, this: this.cast(), signature }
}

static TABLE: abi::ColliderTable = abi::ColliderTable {
    size: size_of::<abi::ColliderTable>() as u32,
    reserved: 0,
    card: Some(card),
    body_contacts: Some(body_contacts),
    body_hits: Some(body_hits),
    self_contacts: Some(self_contacts),
    conservative_bounds: Some(conservative_bounds),
    self_crossings: Some(self_crossings),
    share: Some(share),
    why: Some(why),
    destroy: Some(destroy),
};

unsafe fn scheme<'a>(this: *const c_void) -> &'a dyn Collide {
    unsafe { &*this.cast::<Collider>() }.scheme.as_ref()
}

unsafe fn points<'a>(cloth: *const Cloth) -> &'a [Point3] {
    let cloth = unsafe { &*cloth };
    unsafe { list(cloth.positions.cast(), cloth.points, "the points") }.unwrap_or(&[])
}

unsafe fn triangles<'a>(cloth: *const Cloth) -> &'a [[u32; 3]] {
    let cloth = unsafe { &*cloth };
    unsafe { list(cloth.triangles.cast(), cloth.triangle_count, "the triangles") }.unwrap_or(&[])
}

/// Writes results into the asker's list.
unsafe fn fill<T: Copy>(sink: *const Sink, found: &[T]) -> Result<(), String> {
    let sink = unsafe { &*sink };
    if found.is_empty() {
        return Ok(());
    }
    let room = sink.grow.map_or(std::ptr::null_mut(), |grow| unsafe { grow(sink.ctx, found.len()) });
    if room.is_null() {
        return Err("there is no room for its results".into());
    }
    unsafe { std::ptr::copy_nonoverlapping(found.as_ptr(), room.cast::<T>(), found.len()) };
    Ok(())
}

unsafe extern "C" fn card(this: *const c_void, out: *mut abi::ColliderCard) -> i32 {
    guarded(|| {
        let card = unsafe { scheme(this) }.card();
        let (penalty_law, penalty) = match card.penalty {
            None => (LINEAR, f64::NAN),
            Some(Penalty::Linear(c)) => (LINEAR, c),
            Some(Penalty::Exponential(c)) => (EXPONENTIAL, c),
        };
        let (thickness, friction, restitution) = (card.thickness, card.friction, card.restitution);
        let self_collision = u32::from(card.self_collision);
        let card =
            abi::ColliderCard { thickness, friction, restitution, penalty, self_collision, penalty_law };
        unsafe { out.write(card) };
        Ok(())
    })
}

unsafe extern "C" fn body_contacts(
    this: *const c_void,
    cloth: *const Cloth,
    reach: f64,
    sink: *const Sink,
) -> i32 {
    guarded(|| {
        let mut found = Vec::new();
        unsafe { scheme(this).body_contacts(points(cloth), reach, &mut found) };
        unsafe { fill(sink, &found) }
    })
}

unsafe extern "C" fn body_hits(
    this: *const c_void,
    from: *const Cloth,
    to: *const Cloth,
    sink: *const Sink,
) -> i32 {
    guarded(|| {
        let mut found = Vec::new();
        unsafe { scheme(this).body_hits(points(from), points(to), &mut found) };
        unsafe { fill(sink, &found) }
    })
}

unsafe extern "C" fn self_contacts(
    this: *const c_void,
    cloth: *const Cloth,
    reach: f64,
    sink: *const Sink,
) -> i32 {
    guarded(|| {
        let mut found = Vec::new();
        unsafe { scheme(this).self_contacts(points(cloth), triangles(cloth), reach, &mut found) };
        unsafe { fill(sink, &found) }
    })
}

unsafe extern "C" fn conservative_bounds(
    this: *const c_void,
    cloth: *const Cloth,
    reach: f64,
    bounds: *mut f64,
) -> i32 {
    guarded(|| {
        let points = unsafe { points(cloth) };
        let found = unsafe { scheme(this).conservative_bounds(points, triangles(cloth), reach) };
        if found.len() != points.len() {
            return Err(format!("it gave {} bounds for {} points", found.len(), points.len()));
        }
        unsafe { std::ptr::copy_nonoverlapping(found.as_ptr(), bounds, found.len()) };
        Ok(())
    })
}

unsafe extern "C" fn self_crossings(this: *const c_void, cloth: *const Cloth, sink: *const Sink) -> i32 {
    guarded(|| unsafe { fill(sink, &scheme(this).self_crossings(points(cloth), triangles(cloth))) })
}

unsafe extern "C" fn share(this: *const c_void, out: *mut abi::Collider) -> i32 {
    guarded(|| {
        unsafe { out.write(lend(&*this.cast::<Collider>())) };
        Ok(())
    })
}

unsafe extern "C" fn why(_: *const c_void) -> Text {
    last_failure()
}

unsafe extern "C" fn destroy(this: *mut c_void) {
    let _ = guarded(|| {
        drop(unsafe { Box::from_raw(this.cast::<Collider>()) });
        Ok(())
    });
}

/// A collider of the other side.
pub struct ForeignCollider {
    collider: abi::Collider,
    table: abi::ColliderTable,
    card: ColliderCard,
    /// Who made it, for messages.
    owner: &'static str,
    /// Keeps the code of the table loaded.
    _library: Option<Arc<dyn Send + Sync>>,
}

// Its functions may be called from any thread, by the rules of the plugin ABI.
unsafe impl Send for ForeignCollider {}
unsafe impl Sync for ForeignCollider {}

impl std::fmt::Debug for ForeignCollider {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "a collider of {}", self.owner)
    }
}

impl Drop for ForeignCollider {
    fn drop(&mut self) {
        if let Some(destroy) = self.table.destroy {
            let _inside = inside(self.owner);
            unsafe { destroy(self.collider.this) };
        }
    }
}

/// Takes over a collider of the other side, which is destroyed with the result.
///
/// Errors: a function or a setting that cannot be; the collider is left as it is then.
///
/// # Safety
/// The collider obeys the rules of the plugin ABI.
pub unsafe fn take(
    collider: *const abi::Collider,
    owner: &'static str,
    library: Option<Arc<dyn Send + Sync>>,
) -> Result<Collider, String> {
    let collider = unsafe { list::<abi::Collider>(collider.cast(), 1, "the collider")? }[0];
    let table = unsafe { list::<abi::ColliderTable>(collider.table.cast(), 1, "the collider's table")? }[0];
    if (table.size as usize) < size_of::<abi::ColliderTable>() {
        let needed = size_of::<abi::ColliderTable>();
        return Err(format!("the collider's table has {} bytes, {needed} are needed", table.size));
    }
    let whole = table.body_contacts.is_some()
        && table.body_hits.is_some()
        && table.self_contacts.is_some()
        && table.conservative_bounds.is_some()
        && table.self_crossings.is_some();
    let read_card = table.card.filter(|_| whole).ok_or("the collider lacks a function")?;
    let mut card = abi::ColliderCard::default();
    if unsafe { read_card(collider.this, &mut card) } != abi::OK {
        return Err("the collider does not give its settings".into());
    }
    let signature = unsafe { text(collider.signature)? }.to_owned();
    let penalty = match (card.penalty.is_nan(), card.penalty_law) {
        (true, _) => None,
        (_, LINEAR) => Some(Penalty::Linear(card.penalty)),
        (_, EXPONENTIAL) => Some(Penalty::Exponential(card.penalty)),
        (_, law) => return Err(format!("the collider has the penalty law {law}, it must be 0 or 1")),
    };
    let card = ColliderCard {
        thickness: card.thickness,
        friction: card.friction,
        restitution: card.restitution,
        self_collision: card.self_collision != 0,
        penalty,
    };
    let foreign = ForeignCollider { collider, table, card, owner, _library: library };
    Ok(Collider { scheme: Arc::new(foreign), signature })
}

/// A collider of the other side that is to live beyond the call.
///
/// # Safety
/// As for [`take`].
pub unsafe fn shared(collider: *const abi::Collider, owner: &'static str) -> Result<Collider, String> {
    let lent = unsafe { list::<abi::Collider>(collider.cast(), 1, "the collider")? }[0];
    let table = unsafe { list::<abi::ColliderTable>(lent.table.cast(), 1, "the collider's table")? }[0];
    let share = table.share.ok_or("the collider cannot be shared")?;
    let mut own = lent;
    if unsafe { share(lent.this, &mut own) } != abi::OK {
        return Err("the collider cannot be shared".into());
    }
    unsafe { take(&own, owner, None) }
}

/// A list that the other side fills.
unsafe extern "C" fn grow<T: Copy>(ctx: *mut c_void, count: usize) -> *mut c_void {
    let found = unsafe { &mut *ctx.cast::<Vec<T>>() };
    let whole = found.capacity().saturating_sub(found.len()) >= count || found.try_reserve(count).is_ok();
    if !whole {
        return std::ptr::null_mut();
    }
    let room = unsafe { found.as_mut_ptr().add(found.len()) };
    // Room that is never filled must not hold noise: a zero byte is a number in every result.
    unsafe {
        std::ptr::write_bytes(room, 0, count);
        found.set_len(found.len() + count);
    }
    room.cast()
}

fn sink<T: Copy>(out: &mut Vec<T>) -> Sink {
    Sink { ctx: std::ptr::from_mut(out).cast(), grow: Some(grow::<T>) }
}

fn cloth(positions: &[Point3], triangles: &[[u32; 3]]) -> Cloth {
    Cloth {
        positions: positions.as_ptr().cast(),
        points: positions.len(),
        triangles: triangles.as_ptr().cast(),
        triangle_count: triangles.len(),
    }
}

impl ForeignCollider {
    /// Leaves the solver with an error: the trait's functions cannot return one, and a contact that
    /// is missed must not pass for none.
    fn ensure(&self, status: i32, what: &str) {
        if status != abi::OK {
            let why = self.table.why.map(|why| unsafe { text(why(self.collider.this)).unwrap_or("") });
            let why = why.filter(|w| !w.is_empty()).map_or(String::new(), |w| format!(": {w}"));
            self.fail(format!("its collider {} in {what}{why}", meaning(status)));
        }
    }

    fn fail(&self, what: String) -> ! {
        let error = StageError::new(ErrorCode::Internal, format!("{}: {what}", self.owner))
            .hint("this is a bug of the plugin, please report it to its author");
        std::panic::resume_unwind(Box::new(error))
    }

    fn ensure_contacts(&self, found: &[BodyContact], points: usize) {
        let sound = |c: &BodyContact| {
            (c.vertex as usize) < points && c.distance.is_finite() && c.normal.iter().all(|x| x.is_finite())
        };
        if let Some(bad) = found.iter().find(|c| !sound(c)) {
            self.fail(format!("its collider gave a contact that cannot be: {bad:?}"));
        }
    }
}

impl Collide for ForeignCollider {
    fn card(&self) -> ColliderCard {
        self.card
    }

    fn body_contacts(&self, positions: &[Point3], reach: f64, out: &mut Vec<BodyContact>) {
        let (from, cloth) = (out.len(), cloth(positions, &[]));
        let Some(ask) = self.table.body_contacts else { return };
        let _inside = inside(self.owner);
        let status = unsafe { ask(self.collider.this, &cloth, reach, &sink(out)) };
        self.ensure(status, "body_contacts");
        self.ensure_contacts(&out[from..], positions.len());
    }

    fn body_hits(&self, from: &[Point3], to: &[Point3], out: &mut Vec<BodyContact>) {
        let start = out.len();
        let Some(ask) = self.table.body_hits else { return };
        let _inside = inside(self.owner);
        let status = unsafe { ask(self.collider.this, &cloth(from, &[]), &cloth(to, &[]), &sink(out)) };
        self.ensure(status, "body_hits");
        self.ensure_contacts(&out[start..], from.len());
    }

    fn self_contacts(&self, positions: &[Point3], tris: &[[u32; 3]], reach: f64, out: &mut Vec<SelfContact>) {
        let start = out.len();
        let Some(ask) = self.table.self_contacts else { return };
        let _inside = inside(self.owner);
        let status = unsafe { ask(self.collider.this, &cloth(positions, tris), reach, &sink(out)) };
        self.ensure(status, "self_contacts");
        let sound = |c: &SelfContact| {
            c.vertices.iter().all(|v| (*v as usize) < positions.len())
                && c.distance.is_finite()
                && c.weights.iter().chain(c.normal.iter()).all(|x| x.is_finite())
        };
        if let Some(bad) = out[start..].iter().find(|c| !sound(c)) {
            self.fail(format!("its collider gave a contact that cannot be: {bad:?}"));
        }
    }

    fn conservative_bounds(&self, positions: &[Point3], tris: &[[u32; 3]], reach: f64) -> Vec<f64> {
        let mut bounds = vec![0.0; positions.len()];
        let Some(ask) = self.table.conservative_bounds else { return bounds };
        let _inside = inside(self.owner);
        let status = unsafe { ask(self.collider.this, &cloth(positions, tris), reach, bounds.as_mut_ptr()) };
        self.ensure(status, "conservative_bounds");
        if let Some(bad) = bounds.iter().find(|b| !(b.is_finite() && **b >= 0.0)) {
            self.fail(format!("its collider gave the bound {bad}"));
        }
        bounds
    }

    fn self_crossings(&self, positions: &[Point3], tris: &[[u32; 3]]) -> Vec<[u32; 2]> {
        let mut found: Vec<[u32; 2]> = Vec::new();
        let Some(ask) = self.table.self_crossings else { return found };
        let _inside = inside(self.owner);
        let status = unsafe { ask(self.collider.this, &cloth(positions, tris), &sink(&mut found)) };
        self.ensure(status, "self_crossings");
        if let Some(bad) = found.iter().flatten().find(|t| **t as usize >= tris.len()) {
            self.fail(format!("its collider names triangle {bad} of {}", tris.len()));
        }
        found
    }
}

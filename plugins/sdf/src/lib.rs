//! A collider that keeps the body as a signed-distance grid.
//!
//! A question about the body costs eight numbers of the grid and no search, whatever the body's
//! number of triangles; what is paid is memory and the fineness of the skin, both by `cell`.
//!
//! - [`SdfCollider`]: the stage.
//! - [`DistanceField`]: the grid, its making and its questions.
//! - [`SdfScheme`]: the service that solvers call.
//! - `skin`: the body's triangles with the normals that give a distance its sign.
//! - `cloth`: cloth against itself, by a uniform grid and exact tests.
//! - `closest`: closest points of triangles and segments.

mod closest;
mod cloth;
mod field;
mod scheme;
mod skin;

pub use field::DistanceField;
pub use scheme::SdfScheme;

use std::sync::Arc;
use toile_core::param::ron_text;
use toile_core::prelude::*;

/// Keeps cloth out of the body by a signed-distance grid, and out of itself.
///
/// Far from the skin a question costs eight numbers of the grid; near it the closest point of the
/// skin is found from the triangles that these nodes are closest to. On the mannequin, with cells
/// of 8 mm, 99 of 100 distances below 1 cm are exact and the worst is 0.1 mm off; up to 5 cm they
/// are interpolated, 0.05 mm off in the median, 4 mm at worst; beyond that they are a little too
/// long. The grid of 2.3 million nodes takes two seconds to make and 19 MB.
///
/// The body must be a closed mesh that faces outwards. Without a body only cloth against itself is
/// looked for.
#[stage(
    role = Collider,
    source = "Baerentzen & Aanaes 2005; Bridson 2003",
    example = "SdfCollider(cell: \"8 mm\", thickness: \"1.5 mm\", friction: 0.3)",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct SdfCollider {
    /// Distance of the grid's nodes: half of it costs eight times the memory.
    #[param(default = Length::mm(8.0), min = 1e-4, max = 0.1, trades, finer = "less")]
    pub cell: Length,
    /// Distance at which cloth is held off the body and off itself.
    #[param(default = Length::mm(1.5), min = 1e-5, max = 0.05, trades)]
    pub thickness: Length,
    /// Coulomb friction coefficient.
    #[param(default = 0.3, min = 0, max = 2)]
    pub friction: f64,
    /// Share of the speed that is thrown back, 0 for cloth that stays where it lands.
    #[param(default = 0.0, min = 0, max = 1)]
    pub restitution: f64,
    /// True where cloth is kept out of itself.
    #[param(default = true, trades)]
    pub self_collision: bool,
    /// A force that pushes cloth off the body, for solvers that step in time; without it contacts
    /// are resolved by impulses. `Linear(c)`: c (thickness - distance) within the thickness, c in
    /// N/m per vertex. `Exponential(c)`: c exp(-distance / thickness), c in N per vertex.
    #[param(default = None, min = 0, max = 1e6)]
    pub penalty: Option<Penalty>,
}

#[stage]
impl SdfCollider {
    fn run(&self, body: Option<&Body>, cx: &Context) -> Result<Collider, StageError> {
        if body.is_none() && !self.self_collision {
            cx.warn("there is no body and self-collision is off: nothing is kept apart");
        }
        let field = body.map(|b| DistanceField::of(b, self.cell.metres(), cx)).transpose()?;
        if let Some(field) = &field {
            cx.figure("grid_nodes", field.nodes() as f64, "");
        }
        let scheme = Arc::new(SdfScheme::new(self.card(), field));
        Ok(Collider { scheme, signature: self.signature(body) })
    }

    fn card(&self) -> ColliderCard {
        ColliderCard {
            thickness: self.thickness.metres(),
            friction: self.friction,
            restitution: self.restitution,
            self_collision: self.self_collision,
            penalty: self.penalty,
        }
    }

    /// Names scheme, settings and body, so that colliders with different answers differ in it.
    fn signature(&self, body: Option<&Body>) -> String {
        let digest = |b: &Body| {
            let mut d = Digester::new();
            b.digest(&mut d);
            d.finish().short()
        };
        format!("SdfCollider{} body {}", ron_text(self), body.map_or_else(|| "none".into(), digest))
    }
}

toile_core::plugin!(SdfCollider);

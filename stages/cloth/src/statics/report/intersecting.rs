//! Errors of a level that cannot be solved: intersections that were not resolved, or a step without
//! a solution.

use crate::scene::Scene;
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::levels::mesh_level::Level;
use crate::statics::levels::pieces::Pieces;
use crate::statics::report::error::{StaticsError, Unsolvable};
use crate::statics::report::load::Load;
use crate::statics::report::words;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// The intersections of a level.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Intersections {
    /// Nodes of the level.
    pub(crate) nodes: usize,
    /// Two panels of it, counted from 1.
    panels: [u32; 2],
    /// How many pairs of features.
    pairs: usize,
    /// The place of one of them, m.
    at: Vec3,
}

/// The error of intersections of the finest level that were not resolved.
pub(crate) fn intersecting_error(scene: &Scene, gravity: f64, intersections: Intersections) -> StaticsError {
    let Intersections { panels, pairs, at, .. } = intersections;
    let panels = panels.map(|p| words::panel(scene, p));
    StaticsError::Tangled { panels, pairs, at, load: Load::of(scene, gravity) }
}

/// The intersections of a level.
pub(crate) fn intersections_of(pieces: &Pieces, level: &Level<'_>) -> Intersections {
    let groups = level.system.get::<SelfContact>().map_or_else(Vec::new, |c| c.intersecting_nodes(&level.x));
    let first = groups.first().copied().unwrap_or_default();
    let panel = |node: u32| {
        let vertex = pieces.node.iter().position(|n| *n == node);
        vertex.map_or(0, |v| pieces.panel[v])
    };
    Intersections {
        nodes: level.x.len(),
        panels: [panel(first[0]), panel(first[3])],
        pairs: groups.len().max(1),
        at: level.x.get(first[0] as usize).copied().unwrap_or_default(),
    }
}

/// The error of a step that has no solution near a vertex of the finest level.
pub(crate) fn unsolvable(scene: &Scene, vertex: usize, at: &Vec3) -> StaticsError {
    let number = scene.panels.iter().position(|p| p.vertices.contains(&vertex)).map_or(0, |k| k as u32 + 1);
    let mut around = scene.triangles.iter().filter(|t| t.contains(&(vertex as u32))).peekable();
    let has_area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| scene.positions[v as usize]);
        (b - a).cross(&(c - a)).norm() > 1e-12 * (b - a).norm() * (c - a).norm()
    };
    let why = if around.peek().is_none() {
        Unsolvable::Loose
    } else if !at.iter().all(|v| v.is_finite()) {
        Unsolvable::Lost
    } else if !around.any(has_area) {
        Unsolvable::Flat
    } else {
        Unsolvable::Apart
    };
    StaticsError::Unsolvable { vertex, panel: words::panel(scene, number), why }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::generate;

    #[test]
    fn the_load_is_that_of_the_panel_that_stretches_most() {
        let mut scene = generate::hang(4);
        let load = Load::of(&scene, 10.0);
        assert!((load.length - 1.0).abs() < 1e-9);
        assert!((load.weight - scene.material.density * 10.0).abs() < 1e-9);
        scene.material.density *= 1000.0;
        assert!((Load::of(&scene, 10.0).strain() / load.strain() - 1000.0).abs() < 1e-6);
    }

    #[test]
    fn the_cause_is_the_load_only_where_it_is_great() {
        let load = Load { length: 0.5, weight: 750.0, stiffness: 500.0 };
        assert_eq!(
            load.to_string(),
            "a length of 0.50 m weighs 750.0 N a metre of width, which stretches a stiffness of 500.0 N/m by 150 %; look whether \
             the area density is in kg/m^2 and the stiffness in N/m"
        );
        let light = Load { weight: 0.75, ..load }.to_string();
        assert!(
            light.ends_with(" by 0 %; place its panels more smoothly, or begin on a finer mesh"),
            "{light}"
        );
    }

    #[test]
    fn a_step_without_a_solution_names_the_vertex_and_the_cause() {
        let mut scene = generate::hang(2);
        let told = |scene: &Scene| unsolvable(scene, 4, &Vec3::zeros()).to_string();
        assert!(told(&scene).starts_with("no step can be solved at vertex 4 of panel "), "{}", told(&scene));
        scene.positions.iter_mut().for_each(|p| *p = Vec3::x() * p.x);
        assert!(
            told(&scene).ends_with("its triangles have no area where they start; lay the panel out flat")
        );
        scene.triangles.retain(|t| !t.contains(&4));
        assert!(told(&scene).ends_with("it belongs to no triangle; remove it, or give it one"));
    }
}

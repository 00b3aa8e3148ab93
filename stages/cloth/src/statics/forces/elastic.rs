//! The elastic energy of the sheet of a level: the energies of the chosen models, their places in
//! the matrix, and the constant part of the matrix, which is summed once per pattern. Cost: O(n).

use crate::energy::bending::Creases;
use crate::energy::{Band, Bands, Cloth, Models, Places, Projection, Resistance, Subset, Vec3};
use crate::error::ClothError;
use crate::linear::Pattern;
use nalgebra::Matrix3;

/// Rounds of smoothing before the folds of a prolonged state are taken over, which lie along the
/// edges of the coarser mesh.
const ROUNDS: usize = 4;

/// The elastic energy of a sheet.
pub struct Elastic {
    energies: Vec<Box<dyn Resistance>>,
    /// The corners of the triangles.
    faces: Vec<[u32; 3]>,
    /// The places of the blocks in the matrix of the sheet alone.
    own: MatrixLayout,
    /// The same in the matrix with contacts.
    placed: MatrixLayout,
}

/// The places of each energy in a matrix, and the sum of the constant part.
#[derive(Debug, Clone, Default)]
struct MatrixLayout {
    places: Vec<Places>,
    constant: Vec<Matrix3<f64>>,
}

impl std::fmt::Debug for Elastic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.energies.iter().map(|e| e.name())).finish()
    }
}

impl Clone for Elastic {
    fn clone(&self) -> Self {
        Self {
            energies: self.energies.iter().map(|e| e.boxed()).collect(),
            faces: self.faces.clone(),
            own: self.own.clone(),
            placed: self.placed.clone(),
        }
    }
}

impl Elastic {
    /// The models of a cloth with its elastic bands and creases. A crease is the index of a hinge
    /// among the inner edges, and the rest angle between the outsides of its sheets, radians.
    ///
    /// # Errors
    /// Faults that the models find in a fabric.
    pub fn new(
        models: Models,
        cloth: &Cloth<'_>,
        bands: Vec<Band>,
        creases: &[(usize, f64)],
    ) -> Result<Self, ClothError> {
        let mut energies = models.energies(cloth)?;
        if !bands.is_empty() {
            energies.push(Box::new(Bands::new(bands)));
        }
        if !creases.is_empty() && energies.len() > 1 {
            energies.push(Box::new(Creases::new(cloth, creases)));
        }
        let faces = cloth.sheet.triangles().to_vec();
        Ok(Self { energies, faces, own: MatrixLayout::default(), placed: MatrixLayout::default() })
    }

    /// Makes bending so many times stiffer, from the next [`Self::bind`] on.
    pub fn scale_bending(&mut self, by: f64) {
        self.energies.iter_mut().for_each(|e| e.scale_bending(by));
    }

    /// The corners of its triangles.
    pub(crate) fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Visits the groups of nodes that it couples.
    pub fn couplings(&self, visit: &mut dyn FnMut(&[u32])) {
        self.energies.iter().for_each(|e| e.couplings(visit));
    }

    /// Finds the places of its blocks. The pattern must contain its couplings, except those of held
    /// nodes.
    pub fn bind(&mut self, pattern: &Pattern) {
        let places: Vec<Places> = self.energies.iter().map(|e| e.places(pattern)).collect();
        let mut constant = vec![Matrix3::zeros(); pattern.blocks()];
        let nowhere = vec![Vec3::zeros(); pattern.nodes()];
        for (e, places) in self.energies.iter().zip(&places).filter(|(e, _)| e.is_constant()) {
            e.add_matrix(&nowhere, Projection::PositiveSemiDefinite, places, &mut constant);
        }
        self.own = MatrixLayout { places, constant };
        self.placed = self.own.clone();
    }

    /// Finds its places in a wider pattern, in which the slots of the pattern of the last
    /// [`Self::bind`] are at `slots`.
    pub fn follow(&mut self, pattern: &Pattern, slots: &[u32]) {
        let blocks = pattern.blocks();
        self.placed.places = self.own.places.iter().map(|p| p.moved(slots, blocks)).collect();
        self.placed.constant.clear();
        self.placed.constant.resize(blocks, Matrix3::zeros());
        slots.iter().zip(&self.own.constant).for_each(|(&s, c)| self.placed.constant[s as usize] = *c);
    }

    /// Keeps the stress that the linear model predicts for `moves` from `x`.
    pub fn predict(&mut self, x: &[Vec3], moves: &[Vec3]) {
        self.energies.iter_mut().for_each(|e| e.predict(x, moves));
    }

    /// Stored energy, J.
    #[must_use]
    pub fn value(&self, x: &[Vec3]) -> f64 {
        self.energies.iter().filter(|e| !e.is_hysteretic()).map(|e| e.value(x)).sum()
    }

    /// The potential of bending hysteresis, J.
    #[must_use]
    pub fn value_of_holds(&self, x: &[Vec3]) -> f64 {
        self.energies.iter().filter(|e| e.is_hysteretic()).map(|e| e.value(x)).sum()
    }

    /// Adds the gradient of the stored energy and of the bending hysteresis, N.
    pub fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        self.energies.iter().for_each(|e| e.add_gradient(x, gradient));
    }

    /// Writes the second derivative with the predicted stress and a share of its `compression`,
    /// N/m; positive semi-definite without any.
    pub fn write_matrix(&self, x: &[Vec3], compression: f64, values: &mut [Matrix3<f64>]) {
        values.copy_from_slice(&self.placed.constant);
        let form = Projection::Compressed(compression);
        for (e, places) in self.energies.iter().zip(&self.placed.places).filter(|(e, _)| !e.is_constant()) {
            e.add_matrix(x, form, places, values);
        }
    }

    /// Whether friction between yarns holds any fold.
    #[cfg(test)]
    pub(crate) fn holds(&self) -> bool {
        !self.held().is_empty()
    }

    /// Sets the angles of bending hysteresis to the folds at `x`, which are smoothed first where
    /// they are prolonged from a coarser mesh.
    pub(crate) fn hold(&mut self, x: &[Vec3], is_prolonged: bool) {
        if self.energies.iter().any(|e| e.is_hysteretic()) {
            let smooth = if is_prolonged { smoothed(&self.faces, x) } else { x.to_vec() };
            self.energies.iter_mut().for_each(|e| e.hold(&smooth));
        }
    }

    /// The angles of bending hysteresis, by hinge; empty where there is none.
    pub(crate) fn held(&self) -> &[f64] {
        self.energies.iter().find(|e| e.is_hysteretic()).map_or(&[], |e| e.held())
    }

    /// Sets the angles of bending hysteresis, if there are as many as hinges.
    pub(crate) fn hold_at(&mut self, held: &[f64]) {
        self.energies.iter_mut().for_each(|e| e.hold_at(held));
    }

    /// Moves the angles of bending hysteresis along with folds that turn.
    pub(crate) fn drag(&mut self, x: &[Vec3]) {
        self.energies.iter_mut().for_each(|e| e.drag(x));
    }

    /// The elements that an active node is in.
    pub(crate) fn part(&self, subset: &Subset) -> Self {
        let touched = self.faces.iter().filter(|f| subset.touches(&f[..]));
        Self {
            energies: self.energies.iter().map(|e| e.part(subset)).collect(),
            faces: touched.map(|f| subset.renumbered(*f)).collect(),
            own: MatrixLayout::default(),
            placed: MatrixLayout::default(),
        }
    }

    /// Takes over the predicted stress and the angles of bending hysteresis of a subset.
    pub(crate) fn merge(&mut self, subset: &Subset, part: &Self) {
        self.energies.iter_mut().zip(&part.energies).for_each(|(e, p)| e.merge(subset, p.as_ref()));
    }
}

/// Positions smoothed towards the mean of their neighbours, except on open edges.
fn smoothed(faces: &[[u32; 3]], x: &[Vec3]) -> Vec<Vec3> {
    let mut sides: Vec<[u32; 2]> = faces.iter().flat_map(sides).collect();
    sides.sort_unstable();
    let mut open = vec![false; x.len()];
    for run in sides.chunk_by(|a, b| a == b).filter(|run| run.len() == 1) {
        run[0].iter().for_each(|&i| open[i as usize] = true);
    }
    sides.dedup();
    let mut smooth = x.to_vec();
    for _ in 0..ROUNDS {
        let mut sums = vec![(Vec3::zeros(), 0.0); x.len()];
        for &[a, b] in &sides {
            for (i, j) in [(a as usize, b as usize), (b as usize, a as usize)] {
                sums[i] = (sums[i].0 + smooth[j], sums[i].1 + 1.0);
            }
        }
        for (k, (sum, count)) in sums.into_iter().enumerate().filter(|(k, s)| !open[*k] && s.1 > 0.0) {
            smooth[k] = (smooth[k] + sum / count) * 0.5;
        }
    }
    smooth
}

/// The sides of a triangle, each with its lower node first.
fn sides(t: &[u32; 3]) -> [[u32; 2]; 3] {
    [0, 1, 2].map(|k| {
        let (a, b) = (t[k], t[(k + 1) % 3]);
        [a.min(b), a.max(b)]
    })
}

#[cfg(test)]
mod tests;

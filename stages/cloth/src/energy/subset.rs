//! A subset of a mesh: the active nodes, and the elements around them as a smaller mesh.

/// Marks a node that is not in the subset.
pub(crate) const NONE: u32 = u32::MAX;

/// Which nodes are active, and the numbers of the nodes in the subset and in the whole.
#[derive(Debug, Clone)]
pub struct Subset {
    active: Vec<bool>,
    index: Vec<u32>,
    nodes: Vec<u32>,
}

impl Subset {
    /// The `active` nodes and all that are `included`, renumbered in their order.
    pub(crate) fn new(active: Vec<bool>, included: &[bool]) -> Self {
        let nodes: Vec<u32> = (0..active.len() as u32).filter(|&i| included[i as usize]).collect();
        let mut index = vec![NONE; active.len()];
        nodes.iter().zip(0u32..).for_each(|(&i, k)| index[i as usize] = k);
        Self { active, index, nodes }
    }

    /// The numbers in the whole of the nodes of the subset, ascending.
    pub(crate) fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// The values of the whole at the nodes of the subset.
    pub(crate) fn pick<T: Clone>(&self, of: &[T]) -> Vec<T> {
        self.nodes.iter().filter_map(|&i| of.get(i as usize)).cloned().collect()
    }

    /// Writes the values of the subset into those of the whole.
    pub(crate) fn put<T: Clone>(&self, from: &[T], to: &mut [T]) {
        self.nodes.iter().zip(from).for_each(|(&i, v)| to[i as usize] = v.clone());
    }

    /// Which nodes are active.
    pub(crate) fn active(&self) -> &[bool] {
        &self.active
    }

    /// The number of each node in the subset; [`NONE`] where it is not in it.
    pub(crate) fn index(&self) -> &[u32] {
        &self.index
    }

    /// Whether an element has an active node.
    pub(crate) fn touches(&self, nodes: &[u32]) -> bool {
        nodes.iter().any(|&i| self.active[i as usize])
    }

    /// Whether the subset has all of an element's nodes.
    pub(crate) fn has_all(&self, nodes: &[u32]) -> bool {
        nodes.iter().all(|&i| self.index[i as usize] != NONE)
    }

    /// Whether the subset has an active node of an element, and all of its nodes.
    pub(crate) fn knows(&self, nodes: &[u32]) -> bool {
        self.touches(nodes) && self.has_all(nodes)
    }

    /// The element's nodes in the subset.
    pub(crate) fn renumbered<const N: usize>(&self, nodes: [u32; N]) -> [u32; N] {
        nodes.map(|i| self.index[i as usize])
    }

    /// An element of the subset, by its nodes in the whole.
    pub(crate) fn in_whole<const N: usize>(&self, nodes: [u32; N]) -> [u32; N] {
        nodes.map(|i| self.nodes[i as usize])
    }
}

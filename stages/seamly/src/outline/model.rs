//! The objects of modeling, which stand for those of the draft.

use super::super::draft::BLOCKS;
use super::super::source::{children, number};
use roxmltree::Node;
use std::collections::{BTreeMap, BTreeSet};

/// What the numbers in pieces stand for.
#[derive(Debug)]
pub(super) struct Modeling<'a, 't> {
    /// The object of the draft of each.
    objects: BTreeMap<u32, u32>,
    /// Paths within pieces.
    pub(super) paths: BTreeMap<u32, Node<'a, 't>>,
    /// Objects that a union of pieces has made.
    pub(super) united: BTreeSet<u32>,
}

impl<'a, 't: 'a> Modeling<'a, 't> {
    pub(super) fn of(root: Node<'a, 't>) -> Self {
        let (mut objects, mut paths, mut united) = (BTreeMap::new(), BTreeMap::new(), BTreeSet::new());
        for node in children(root, BLOCKS).flat_map(|b| children(b, &["modeling"])) {
            for one in node.children().filter(Node::is_element) {
                let id = number(one, "id");
                match (one.tag_name().name(), id, number(one, "idObject")) {
                    ("path", Some(id), _) => {
                        paths.insert(id, one);
                    }
                    ("tools", _, _) => {
                        let children = one.descendants().filter(|n| n.has_tag_name("child"));
                        united.extend(children.filter_map(|n| n.text()?.trim().parse::<u32>().ok()));
                    }
                    (_, Some(id), Some(object)) => {
                        objects.insert(id, object);
                    }
                    _ => {}
                }
            }
        }
        Modeling { objects, paths, united }
    }

    /// The object of the draft that a number stands for; itself where modeling does not have it.
    pub(super) fn object(&self, id: u32) -> u32 {
        self.objects.get(&id).copied().unwrap_or(id)
    }
}

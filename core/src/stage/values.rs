//! What stages take and give: values on ports, and how a typed function receives and returns them.

use super::{Arity, OutPort};
use crate::artifact::{Artifact, ArtifactType, Kind};
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A value on a port: one artifact, or a named set of one kind.
#[derive(Debug, Clone)]
pub enum PortValue {
    /// A single artifact.
    One(Arc<dyn Artifact>),
    /// A named set.
    Set(Kind, BTreeMap<String, Arc<dyn Artifact>>),
}

impl PortValue {
    /// The kind of what it holds.
    pub fn kind(&self) -> Kind {
        match self {
            PortValue::One(a) => a.kind(),
            PortValue::Set(kind, _) => *kind,
        }
    }

    /// Its artifacts with their names; a single artifact has the empty name.
    pub fn entries(&self) -> Vec<(&str, &Arc<dyn Artifact>)> {
        match self {
            PortValue::One(a) => vec![("", a)],
            PortValue::Set(_, set) => set.iter().map(|(k, v)| (k.as_str(), v)).collect(),
        }
    }
}

/// The values of a stage's input ports, in the order of its card; `None` for an optional port
/// that nothing feeds.
#[derive(Debug, Clone, Default)]
pub struct Inputs(pub Vec<Option<PortValue>>);

/// A named set of artifacts of one type, in the order of their names.
#[derive(Debug, Clone)]
pub struct Set<T>(pub BTreeMap<String, Arc<T>>);

impl<T> Set<T> {
    /// Names and values in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &T)> {
        self.0.iter().map(|(k, v)| (k.as_str(), v.as_ref()))
    }

    /// The value of that name.
    pub fn get(&self, name: &str) -> Option<&T> {
        self.0.get(name).map(Arc::as_ref)
    }
}

impl<T> FromIterator<(String, T)> for Set<T> {
    fn from_iter<I: IntoIterator<Item = (String, T)>>(items: I) -> Self {
        Set(items.into_iter().map(|(k, v)| (k, Arc::new(v))).collect())
    }
}

/// A type that may stand as an argument of a stage's typed function.
pub trait Input<'a>: Sized {
    /// Kind, arity and optionality of the port.
    fn port() -> (Kind, Arity, bool);
    /// Takes it from a port.
    fn take(value: Option<&'a PortValue>) -> Option<Self>;
}

fn downcast<T: ArtifactType>(artifact: &Arc<dyn Artifact>) -> Option<&T> {
    let any: &dyn Any = artifact.as_ref();
    any.downcast_ref()
}

impl<'a, T: ArtifactType> Input<'a> for &'a T {
    fn port() -> (Kind, Arity, bool) {
        (T::KIND, if T::IN_SETS { Arity::Each } else { Arity::One }, false)
    }
    fn take(value: Option<&'a PortValue>) -> Option<Self> {
        match value {
            Some(PortValue::One(a)) => downcast(a),
            _ => None,
        }
    }
}

impl<T: ArtifactType> Input<'_> for Set<T> {
    fn port() -> (Kind, Arity, bool) {
        (T::KIND, Arity::All, false)
    }
    fn take(value: Option<&PortValue>) -> Option<Self> {
        let typed = |(k, v): (&String, &Arc<dyn Artifact>)| {
            let any: Arc<dyn Any + Send + Sync> = v.clone();
            any.downcast::<T>().ok().map(|v| (k.clone(), v))
        };
        match value {
            Some(PortValue::Set(_, set)) => set.iter().map(typed).collect::<Option<_>>().map(Set),
            _ => None,
        }
    }
}

impl<'a, I: Input<'a>> Input<'a> for Option<I> {
    fn port() -> (Kind, Arity, bool) {
        let (kind, arity, _) = I::port();
        (kind, arity, true)
    }
    fn take(value: Option<&'a PortValue>) -> Option<Self> {
        match value {
            None => Some(None),
            some => I::take(some).map(Some),
        }
    }
}

/// A type that a stage's typed function may return.
pub trait Output {
    /// Its ports.
    fn ports() -> Vec<OutPort>;
    /// Its values, in the order of the ports.
    fn pack(self) -> Vec<PortValue>;
}

impl<T: ArtifactType> Output for T {
    fn ports() -> Vec<OutPort> {
        vec![OutPort { kind: T::KIND, arity: Arity::One }]
    }
    fn pack(self) -> Vec<PortValue> {
        vec![PortValue::One(Arc::new(self))]
    }
}

impl<T: ArtifactType> Output for Set<T> {
    fn ports() -> Vec<OutPort> {
        vec![OutPort { kind: T::KIND, arity: Arity::All }]
    }
    fn pack(self) -> Vec<PortValue> {
        let erase = |(k, v): (String, Arc<T>)| (k, v as Arc<dyn Artifact>);
        vec![PortValue::Set(T::KIND, self.0.into_iter().map(erase).collect())]
    }
}

impl<A: Output, B: Output> Output for (A, B) {
    fn ports() -> Vec<OutPort> {
        [A::ports(), B::ports()].concat()
    }
    fn pack(self) -> Vec<PortValue> {
        [self.0.pack(), self.1.pack()].concat()
    }
}

impl<A: Output, B: Output, C: Output> Output for (A, B, C) {
    fn ports() -> Vec<OutPort> {
        [A::ports(), B::ports(), C::ports()].concat()
    }
    fn pack(self) -> Vec<PortValue> {
        [self.0.pack(), self.1.pack(), self.2.pack()].concat()
    }
}

impl<A: Output, B: Output, C: Output, D: Output> Output for (A, B, C, D) {
    fn ports() -> Vec<OutPort> {
        [A::ports(), B::ports(), C::ports(), D::ports()].concat()
    }
    fn pack(self) -> Vec<PortValue> {
        [self.0.pack(), self.1.pack(), self.2.pack(), self.3.pack()].concat()
    }
}

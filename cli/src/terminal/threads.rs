//! The threads that a command works on: as many as are requested, as the machine has cores, as the
//! system gives.

use crate::Streams;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::num::NonZero;

/// Threads, where there are some.
pub(crate) type Pool = Result<ThreadPool, ThreadPoolBuildError>;

/// A pool of threads for work of the present thread. Warns if more threads are requested than the
/// machine has cores, or than the system gives.
///
/// More threads than cores only wait for each other. Where the system starts no thread at all, the
/// present one does the work.
pub(crate) fn pool(asked: Option<u16>, streams: &mut Streams<'_>) -> Pool {
    let (pool, told) = pool_of(asked, cores());
    told.into_iter().for_each(|words| streams.warn(words));
    pool
}

/// Runs `work` in a pool, or where there is none on the threads of the whole program.
pub(crate) fn in_pool<T: Send>(pool: Pool, work: impl FnOnce() -> T + Send) -> T {
    match pool {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

/// Sets up the threads of the whole program, for commands that take those: as many as the system
/// gives, else the present one.
pub(crate) fn for_the_program() {
    // That pool can be tried once only, so others are tried before.
    let given = halves(cores()).find(|n| ThreadPoolBuilder::new().num_threads(*n).build().is_ok());
    let _ = match given {
        Some(n) => ThreadPoolBuilder::new().num_threads(n).build_global(),
        None => ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global(),
    };
}

/// The machine's cores that this program may use.
pub(crate) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZero::get)
}

/// A pool of threads for work of the present thread on a machine of so many cores, and the warnings
/// about it.
pub(crate) fn pool_of(asked: Option<u16>, cores: usize) -> (Pool, Vec<String>) {
    let mut told = Vec::new();
    let most = asked.map_or(cores, usize::from);
    if most > cores {
        told.push(format!(
            "{most} threads are requested and this machine has {}; it works on {cores}",
            cores_in_words(cores)
        ));
    }
    let wanted = most.min(cores);
    for n in halves(wanted) {
        if let Ok(pool) = ThreadPoolBuilder::new().num_threads(n).build() {
            if n < wanted {
                told.push(format!("the system gives {n} of {wanted} threads"));
            }
            return (Ok(pool), told);
        }
    }
    told.push("the system gives no threads; one does all the work".into());
    (ThreadPoolBuilder::new().num_threads(1).use_current_thread().build(), told)
}

fn cores_in_words(cores: usize) -> String {
    if cores == 1 { "1 core".into() } else { format!("{cores} cores") }
}

/// A number, its half, and so on down to one.
fn halves(n: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(n.max(1)), |n| (*n > 1).then_some(n / 2))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn threads_are_bounded_by_cores_and_that_is_told() {
        let (pool, told) = pool_of(Some(1024), 2);
        assert_eq!(pool.unwrap().current_num_threads(), 2);
        assert_eq!(told, ["1024 threads are requested and this machine has 2 cores; it works on 2"]);
        let (pool, told) = pool_of(Some(2), 4);
        assert_eq!((pool.unwrap().current_num_threads(), told.len()), (2, 0));
        let (pool, told) = pool_of(None, 3);
        assert_eq!((pool.unwrap().current_num_threads(), told.len()), (3, 0));
        assert_eq!(halves(10).collect::<Vec<_>>(), [10, 5, 2, 1]);
    }
}

//! Work on the pieces of a slice, on as many threads as there are.

/// Calls `work` once for each chunk of `len` items (the last may be shorter) with the
/// chunk's number and a state that calls share only when they come one after the other.
#[cfg(feature = "parallel")]
pub(super) fn for_each<T: Send, S>(
    items: &mut [T],
    len: usize,
    state: impl Fn() -> S + Sync + Send,
    work: impl Fn(&mut S, usize, &mut [T]) + Sync + Send,
) {
    use rayon::prelude::*;

    items
        .par_chunks_mut(len)
        .enumerate()
        .for_each_init(state, |state, (i, chunk)| work(state, i, chunk));
}

/// Calls `work` once for each chunk of `len` items (the last may be shorter) with the
/// chunk's number and one state.
#[cfg(not(feature = "parallel"))]
pub(super) fn for_each<T, S>(
    items: &mut [T],
    len: usize,
    state: impl Fn() -> S,
    work: impl Fn(&mut S, usize, &mut [T]),
) {
    let mut state = state();
    for (i, chunk) in items.chunks_mut(len).enumerate() {
        work(&mut state, i, chunk);
    }
}

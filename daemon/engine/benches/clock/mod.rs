//! Clocks of benchmarks.

use std::time::Instant;

/// Time that this thread was on a processor [ms], where the system tells it (Linux).
fn processor_milliseconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(text.split_whitespace().next()?.parse::<f64>().ok()? * 1e-6)
}

/// Milliseconds that some work takes.
#[derive(Clone, Copy)]
pub struct Spent {
    /// By the clock on the wall.
    pub wall: f64,
    /// On a processor; the wall time where the system does not tell, and below [`SHORT`].
    pub processor: f64,
}

/// The system's account of a thread is renewed every four milliseconds or so [ms].
const SHORT: f64 = 100.0;

/// Does some work and tells what it took.
pub fn spent(work: impl FnOnce()) -> Spent {
    let (start, processor) = (Instant::now(), processor_milliseconds());
    work();
    let wall = 1e3 * start.elapsed().as_secs_f64();
    let processor =
        processor_milliseconds().zip(processor).filter(|_| wall > SHORT).map_or(wall, |(end, start)| end - start);
    Spent { wall, processor }
}

/// Middle of the values in order.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Smallest of the values.
pub fn smallest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

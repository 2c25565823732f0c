//! Ctrl-C and SIGTERM: the first asks a run to stop after its increment, the second ends the process.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tokio::signal::unix::{SignalKind, signal};

use super::{Exit, complain};

/// Whether there are increments whose results could be kept.
static SOLVING: AtomicBool = AtomicBool::new(false);

/// What a shell reports for a process that a signal ended: 128 and the number of the signal.
const SIGNAL_EXIT: i32 = 128;

/// Starts to listen; the flag turns true when the run shall stop after its increment.
pub fn watch() -> Result<Arc<AtomicBool>, Exit> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let runtime = tokio::runtime::Builder::new_current_thread().enable_io().build().map_err(refused)?;
    let thread = std::thread::Builder::new().name("signals".into());
    let (ready, listening) = std::sync::mpsc::channel();
    thread
        .spawn(move || {
            runtime.block_on(async move {
                let streams = signal(SignalKind::interrupt()).and_then(|i| Ok((i, signal(SignalKind::terminate())?)));
                let (mut interrupt, mut terminate) = match streams {
                    Ok(streams) => streams,
                    Err(error) => {
                        let _ = ready.send(Err(error));
                        return;
                    }
                };
                let _ = ready.send(Ok(()));
                loop {
                    let kind = tokio::select! {
                        _ = interrupt.recv() => SignalKind::interrupt(),
                        _ = terminate.recv() => SignalKind::terminate(),
                    };
                    // Nothing to keep, or asked twice.
                    if !SOLVING.load(Ordering::SeqCst) || flag.swap(true, Ordering::SeqCst) {
                        std::process::exit(SIGNAL_EXIT + kind.as_raw_value());
                    }
                    complain("stopping after this increment; once more to stop at once");
                }
            });
        })
        .map_err(refused)?;
    match listening.recv() {
        Ok(Ok(())) => Ok(stop),
        Ok(Err(error)) => Err(refused(error)),
        Err(_) => Err(refused(std::io::Error::other("the thread that waits for signals ended"))),
    }
}

/// From now on a signal lets the present increment finish.
pub fn solving() {
    SOLVING.store(true, Ordering::SeqCst);
}

fn refused(error: std::io::Error) -> Exit {
    complain(&format!("error: cannot wait for signals: {error}"));
    Exit::OurFailure
}

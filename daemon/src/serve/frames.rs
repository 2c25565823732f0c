//! Results published per increment, without ever slowing the solver.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use overclosure_protocol::codec::{self, Format};
use overclosure_protocol::message::Frame;
use tokio::sync::mpsc;
use zenoh::qos::CongestionControl;

/// Frames that may wait to be published.
const FRAMES_WAITING: usize = 1024;
/// Bytes of values that may wait to be published.
const FRAME_BYTES_WAITING: usize = 64 << 20;

/// What the publisher task sends.
enum Outgoing {
    Frame {
        key: String,
        frame: Frame,
    },
    /// No more frames on this key.
    End {
        key: String,
    },
}

/// The way from session threads to the publisher task.
#[derive(Clone)]
pub struct FrameSender {
    sender: mpsc::Sender<Outgoing>,
    gauges: Arc<Gauges>,
}

#[derive(Default)]
struct Gauges {
    bytes_waiting: AtomicUsize,
    dropped: AtomicU64,
}

/// The other end, for [`publish`].
pub struct FrameReceiver {
    receiver: mpsc::Receiver<Outgoing>,
    gauges: Arc<Gauges>,
}

/// A bounded channel for frames.
pub fn channel() -> (FrameSender, FrameReceiver) {
    let (sender, receiver) = mpsc::channel(FRAMES_WAITING);
    let gauges = Arc::new(Gauges::default());
    (FrameSender { sender, gauges: gauges.clone() }, FrameReceiver { receiver, gauges })
}

impl FrameSender {
    /// Hands a frame over; drops and counts it when too much is waiting. Never blocks.
    pub fn send(&self, key: String, frame: Frame) {
        let bytes = bytes_of(&frame);
        let waiting = self.gauges.bytes_waiting.fetch_add(bytes, Ordering::Relaxed);
        let fits = waiting + bytes <= FRAME_BYTES_WAITING;
        if !fits || self.sender.try_send(Outgoing::Frame { key, frame }).is_err() {
            self.gauges.bytes_waiting.fetch_sub(bytes, Ordering::Relaxed);
            self.gauges.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Announces that no more frames come on a key. Waits for room: called by a session thread that is about to end.
    pub fn end(&self, key: String) {
        // An error means that the publisher is gone, and with it the subscribers' connection.
        let _ = self.sender.blocking_send(Outgoing::End { key });
    }

    /// Whether nothing waits to be published.
    pub fn is_empty(&self) -> bool {
        self.sender.capacity() == self.sender.max_capacity()
    }

    /// Frames dropped so far.
    pub fn dropped(&self) -> u64 {
        self.gauges.dropped.load(Ordering::Relaxed)
    }
}

fn bytes_of(frame: &Frame) -> usize {
    size_of_val(frame.values.as_slice()) + size_of_val(frame.labels.as_slice()) + 128
}

/// Publishes until every sender is gone.
pub async fn publish(session: zenoh::Session, mut frames: FrameReceiver) {
    while let Some(outgoing) = frames.receiver.recv().await {
        let outcome = match outgoing {
            Outgoing::Frame { key, frame } => {
                frames.gauges.bytes_waiting.fetch_sub(bytes_of(&frame), Ordering::Relaxed);
                let Ok(bytes) = codec::encode(&frame, Format::Postcard) else { continue };
                let encoding = codec::encoding_of::<Frame>(Format::Postcard);
                session
                    .put(key, bytes)
                    .encoding(encoding)
                    .congestion_control(CongestionControl::Drop)
                    .express(true)
                    .await
            }
            Outgoing::End { key } => {
                session.delete(key).congestion_control(CongestionControl::Drop).express(true).await
            }
        };
        if let Err(error) = outcome {
            tracing::warn!(%error, "a frame could not be published");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_beyond_the_bounds_are_dropped_and_counted() {
        let (sender, mut receiver) = channel();
        for _ in 0..FRAMES_WAITING + 10 {
            sender.send("k".into(), Frame::default());
        }
        assert_eq!(sender.dropped(), 10);
        while receiver.receiver.try_recv().is_ok() {}
        sender.send("k".into(), Frame { values: vec![0.0; FRAME_BYTES_WAITING / 8 + 1], ..Default::default() });
        assert_eq!(sender.dropped(), 11);
    }
}

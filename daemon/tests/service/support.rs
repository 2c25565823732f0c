//! A daemon of its own for each test, on a free port, and ways to talk to it.

use std::io::{BufRead, BufReader};
use std::process::{Child, ChildStdout, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use overclosure_client::blocking::Client;
use overclosure_client::network::{Side, zenoh_config};
use overclosure_client::{Message, Options, StepRequest};
use overclosure_protocol::codec::{self, Format};
use overclosure_protocol::fault::Fault;
use overclosure_protocol::key::{self, SessionVerb};
use zenoh::Wait;

/// The small deck of the examples: two blocks, one input.
pub const DECK: &str = include_str!("../../../examples/two_blocks.inp");
/// Its input.
pub const INPUT: &str = "boundary.NTOP.3";

/// A running daemon; killed when dropped.
pub struct Daemon {
    pub child: Child,
    pub endpoint: String,
    pub id: String,
    _stdout: BufReader<ChildStdout>,
}

/// The executable under test.
pub fn overclosure() -> Command {
    Command::new(env!("CARGO_BIN_EXE_overclosure"))
}

impl Daemon {
    /// With the default limits.
    pub fn start() -> Self {
        Self::start_with("")
    }

    /// With a configuration.
    pub fn start_with(config: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("daemon.toml");
        std::fs::write(&path, config).expect("writable");
        let mut child = overclosure()
            .args(["serve", "--listen", "tcp/127.0.0.1:0", "--config"])
            .arg(&path)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the executable starts");
        let mut stdout = BufReader::new(child.stdout.take().expect("piped"));
        let mut line = String::new();
        stdout.read_line(&mut line).expect("a line");
        // "overclosure 0.1.0 ready: daemon 43d798b8 listens on tcp/127.0.0.1:7447"
        let words: Vec<&str> = line.split_whitespace().collect();
        let after = |word: &str| {
            let at = words.iter().position(|w| *w == word).unwrap_or_else(|| panic!("no {word:?} in {line:?}"));
            words[at + 1].to_owned()
        };
        Self { id: after("daemon"), endpoint: after("on"), child, _stdout: stdout }
    }

    pub fn options(&self) -> Options {
        Options { endpoint: self.endpoint.clone(), attempts: 1, timeout: Duration::from_secs(20), ..Options::default() }
    }

    /// A client that asks once.
    pub fn client(&self) -> Client {
        Client::connect(self.options()).expect("the daemon answers")
    }

    /// A client without any of our code but the configuration.
    pub fn raw(&self) -> Raw {
        let side = Side::Client { connect: vec![self.endpoint.clone()], timeout_ms: 5000 };
        let config = zenoh_config(&side, 1 << 30).expect("a good configuration");
        Raw { zenoh: zenoh::open(config).wait().expect("the daemon is there"), id: self.id.clone() }
    }

    /// Sends SIGTERM.
    pub fn terminate(&self) {
        let status = Command::new("kill").args(["-TERM", &self.child.id().to_string()]).status();
        assert!(status.expect("kill exists").success());
    }

    /// Waits for the end, within a bound.
    pub fn wait(&mut self) -> ExitStatus {
        let deadline = Instant::now() + Duration::from_secs(30);
        loop {
            if let Some(status) = self.child.try_wait().expect("our own child") {
                return status;
            }
            assert!(Instant::now() < deadline, "the daemon does not end");
            std::thread::sleep(Duration::from_millis(10));
        }
    }
}

impl Drop for Daemon {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Bare queries.
pub struct Raw {
    zenoh: zenoh::Session,
    id: String,
}

/// Bytes and encoding of a reply, or of an error reply.
pub type Answer = Result<(Vec<u8>, String), (Vec<u8>, String)>;

impl Raw {
    /// One query; `None` when nobody replies.
    pub fn query(&self, selector: &str, encoding: Option<&str>, payload: Option<&[u8]>) -> Option<Answer> {
        let mut get = self.zenoh.get(selector).timeout(Duration::from_secs(20));
        if let Some(payload) = payload {
            get = get.payload(payload);
        }
        if let Some(encoding) = encoding {
            get = get.encoding(encoding);
        }
        let reply = get.wait().expect("the query is sent").recv().ok()?;
        Some(match reply.into_result() {
            Ok(sample) => Ok((sample.payload().to_bytes().into_owned(), sample.encoding().to_string())),
            Err(error) => Err((error.payload().to_bytes().into_owned(), error.encoding().to_string())),
        })
    }

    /// As a stock tool does it: nothing stated, JSON comes back.
    pub fn json(&self, selector: &str) -> serde_json::Value {
        let (bytes, encoding) = self.query(selector, None, None).expect("a reply").expect("no fault");
        assert!(encoding.starts_with("application/json"), "{encoding}");
        serde_json::from_slice(&bytes).expect("JSON")
    }

    /// The fault of a query, in whichever format it comes.
    pub fn fault(&self, selector: &str, encoding: Option<&str>, payload: Option<&[u8]>) -> Fault {
        let answer = self.query(selector, encoding, payload).expect("a reply");
        let (bytes, encoding) = answer.expect_err("a fault");
        let format = if encoding.starts_with("application/postcard") { Format::Postcard } else { Format::Json };
        assert_eq!(encoding, codec::encoding_of::<Fault>(format), "{}", String::from_utf8_lossy(&bytes));
        codec::decode(&bytes, format, 1 << 20).expect("a fault")
    }

    /// A request of ours to a session, in postcard.
    pub fn post<M: Message>(&self, session: &str, verb: SessionVerb, request: &M) -> Answer {
        let bytes = codec::encode(request, Format::Postcard).expect("encodes");
        let encoding = codec::encoding_of::<M>(Format::Postcard);
        let selector = key::session(&self.id, session, verb);
        self.query(&selector, Some(&encoding), Some(&bytes)).expect("a reply")
    }

    /// A step that must succeed; the bytes of its reply.
    pub fn step(&self, session: &str, request: &StepRequest) -> Vec<u8> {
        self.post(session, SessionVerb::Step, request).expect("no fault").0
    }

    /// The fault of a step.
    pub fn step_fault(&self, session: &str, request: &StepRequest) -> Fault {
        let (bytes, _) = self.post(session, SessionVerb::Step, request).expect_err("a fault");
        codec::decode(&bytes, Format::Postcard, 1 << 20).expect("a fault")
    }

    pub fn key(&self, session: &str, verb: SessionVerb) -> String {
        key::session(&self.id, session, verb)
    }
}

//! Lines of a deck and of the files it includes, one at a time: the text as a whole is never held.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::diagnostic::Place;

use super::report::At;

/// Bytes of one line; longer ones are not deck text.
pub const LINE_BYTES_MAX: usize = 64 * 1024;
/// Depth of `*INCLUDE` in `*INCLUDE`.
pub const INCLUDE_DEPTH_MAX: usize = 16;
/// Files that one deck may include, counted each time.
pub const INCLUDES_MAX: usize = 10_000;

const BUFFER_BYTES: usize = 1 << 20;

/// Knows file and line of every [`At`].
#[derive(Default)]
pub struct SourceMap {
    deck: Option<Arc<PathBuf>>,
    segments: Vec<Segment>,
}

/// Lines from `start` on stand in `file`, the first one on line `line`.
struct Segment {
    start: u32,
    file: Option<Arc<PathBuf>>,
    line: u32,
}

impl SourceMap {
    /// File and line for people.
    pub fn place(&self, at: At) -> Place {
        if at == At::DECK {
            return Place { file: self.deck.clone(), line: 0 };
        }
        let after = self.segments.partition_point(|segment| segment.start <= at.0);
        match after.checked_sub(1).map(|i| &self.segments[i]) {
            Some(segment) => Place { file: segment.file.clone(), line: segment.line + (at.0 - segment.start) },
            None => Place { file: self.deck.clone(), line: at.0 },
        }
    }
}

struct Frame<'a> {
    reader: Box<dyn BufRead + 'a>,
    file: Option<Arc<PathBuf>>,
    /// Resolved path, to find cycles.
    resolved: PathBuf,
    line: u32,
    /// A line that was looked at and not yet taken.
    held: Option<(Vec<u8>, Line)>,
}

impl Frame<'_> {
    fn read(&mut self, ordinal: &mut u32, buffer: &mut Vec<u8>) -> io::Result<Option<Line>> {
        buffer.clear();
        let limit = LINE_BYTES_MAX as u64 + 1;
        if (&mut self.reader).take(limit).read_until(b'\n', buffer)? == 0 {
            return Ok(None);
        }
        self.line = self.line.saturating_add(1);
        *ordinal = ordinal.saturating_add(1).min(At::DECK.0 - 1);
        let at = At(*ordinal);
        if buffer.last() == Some(&b'\n') {
            buffer.pop();
        } else if buffer.len() > LINE_BYTES_MAX {
            return Ok(Some(Line::TooLong(at)));
        }
        if buffer.last() == Some(&b'\r') {
            buffer.pop();
        }
        if self.line == 1 && buffer.starts_with(b"\xef\xbb\xbf") {
            buffer.drain(..3);
        }
        Ok(Some(Line::Text(at)))
    }
}

/// What [`Source::next_line`] found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// A line is in the buffer, without its end.
    Text(At),
    /// The line is longer than [`LINE_BYTES_MAX`].
    TooLong(At),
    /// The last file has ended.
    End,
}

/// Why a file cannot be included.
#[derive(Debug)]
pub enum IncludeFault {
    /// Text that came without a folder.
    NoFolder,
    /// The file is being read already.
    Cycle,
    /// More than [`INCLUDE_DEPTH_MAX`] files deep.
    TooDeep,
    /// More than [`INCLUDES_MAX`] files.
    TooMany,
    /// The file cannot be opened.
    Unreadable(PathBuf, io::Error),
}

/// The deck as a stream of lines.
pub struct Source<'a> {
    frames: Vec<Frame<'a>>,
    map: SourceMap,
    ordinal: u32,
    includes: usize,
}

impl Source<'static> {
    /// A deck in a file.
    pub fn open(path: &Path) -> io::Result<Self> {
        let file = Arc::new(path.to_path_buf());
        let reader = BufReader::with_capacity(BUFFER_BYTES, File::open(path)?);
        let resolved = path.canonicalize()?;
        let mut source = Self::over(Box::new(reader), Some(file.clone()), resolved);
        source.map.deck = Some(file);
        Ok(source)
    }
}

impl<'a> Source<'a> {
    /// A deck in memory.
    pub fn text(text: &'a str) -> Self {
        Self::over(Box::new(text.as_bytes()), None, PathBuf::new())
    }

    fn over(reader: Box<dyn BufRead + 'a>, file: Option<Arc<PathBuf>>, resolved: PathBuf) -> Self {
        let mut source = Self { frames: Vec::new(), map: SourceMap::default(), ordinal: 0, includes: 0 };
        source.push(Frame { reader, file, resolved, line: 0, held: None });
        source
    }

    fn push(&mut self, frame: Frame<'a>) {
        self.map.segments.push(Segment { start: self.ordinal + 1, file: frame.file.clone(), line: 1 });
        self.frames.push(frame);
    }

    /// Continues with the lines of another file, then comes back.
    pub fn include(&mut self, input: &str) -> Result<(), IncludeFault> {
        let folder = match self.frames.last().and_then(|frame| frame.file.as_ref()) {
            Some(file) => file.parent().unwrap_or(Path::new("")).to_path_buf(),
            None => return Err(IncludeFault::NoFolder),
        };
        if self.frames.len() > INCLUDE_DEPTH_MAX {
            return Err(IncludeFault::TooDeep);
        }
        self.includes += 1;
        if self.includes > INCLUDES_MAX {
            return Err(IncludeFault::TooMany);
        }
        let path = folder.join(input);
        let unreadable = |error| IncludeFault::Unreadable(path.clone(), error);
        let resolved = path.canonicalize().map_err(unreadable)?;
        if self.frames.iter().any(|frame| frame.resolved == resolved) {
            return Err(IncludeFault::Cycle);
        }
        if resolved.is_dir() {
            return Err(unreadable(io::ErrorKind::IsADirectory.into()));
        }
        let reader = BufReader::with_capacity(BUFFER_BYTES, File::open(&path).map_err(unreadable)?);
        self.push(Frame { reader: Box::new(reader), file: Some(Arc::new(path)), resolved, line: 0, held: None });
        Ok(())
    }

    /// Reads the next line into `buffer`, without its end.
    pub fn next_line(&mut self, buffer: &mut Vec<u8>) -> io::Result<Line> {
        loop {
            let Some(frame) = self.frames.last_mut() else { return Ok(Line::End) };
            if let Some((held, line)) = frame.held.take() {
                *buffer = held;
                return Ok(line);
            }
            if let Some(line) = frame.read(&mut self.ordinal, buffer)? {
                return Ok(line);
            }
            self.frames.pop();
            if let Some(frame) = self.frames.last() {
                let segment = Segment { start: self.ordinal + 1, file: frame.file.clone(), line: frame.line + 1 };
                self.map.segments.push(segment);
            }
        }
    }

    /// Looks at the next line of the present file without taking it; `None` at the end of the file.
    pub fn peek(&mut self) -> io::Result<Option<&[u8]>> {
        let Some(frame) = self.frames.last_mut() else { return Ok(None) };
        if frame.held.is_none() {
            let mut buffer = Vec::new();
            frame.held = frame.read(&mut self.ordinal, &mut buffer)?.map(|line| (buffer, line));
        }
        Ok(frame.held.as_ref().map(|(text, _)| text.as_slice()))
    }

    /// Hands back the knowledge of files and lines.
    pub fn into_map(self) -> SourceMap {
        self.map
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_lose_their_ends_and_keep_their_numbers() {
        let mut source = Source::text("\u{feff}one\r\n\ntwo");
        let mut buffer = Vec::new();
        let mut lines = Vec::new();
        while let Line::Text(at) = source.next_line(&mut buffer).expect("memory") {
            lines.push((at.0, String::from_utf8_lossy(&buffer).into_owned()));
        }
        assert_eq!(lines, [(1, "one".into()), (2, String::new()), (3, "two".into())]);
    }

    #[test]
    fn a_line_without_end_is_not_swallowed_whole() {
        let text = "x".repeat(LINE_BYTES_MAX + 10);
        let mut source = Source::text(&text);
        assert_eq!(source.next_line(&mut Vec::new()).expect("memory"), Line::TooLong(At(1)));
    }

    #[test]
    fn included_lines_are_placed_in_their_file() {
        let folder = tempfile::tempdir().expect("folder");
        let deck = folder.path().join("deck.inp");
        std::fs::write(&deck, "a\nb\nc\n").expect("write");
        std::fs::write(folder.path().join("sub.inc"), "x\ny\n").expect("write");
        let mut source = Source::open(&deck).expect("open");
        let mut buffer = Vec::new();
        let mut order = Vec::new();
        while let Line::Text(at) = source.next_line(&mut buffer).expect("read") {
            order.push((at, buffer.clone()));
            if buffer == b"b" {
                source.include("sub.inc").expect("include");
            }
        }
        let map = source.into_map();
        let seen: Vec<_> = order
            .iter()
            .map(|(at, text)| {
                let place = map.place(*at);
                let name = place.file.as_ref().and_then(|f| f.file_name()).map(|n| n.to_string_lossy().into_owned());
                (name.unwrap_or_default(), place.line, text[0] as char)
            })
            .collect();
        let expect = [
            ("deck.inp", 1, 'a'),
            ("deck.inp", 2, 'b'),
            ("sub.inc", 1, 'x'),
            ("sub.inc", 2, 'y'),
            ("deck.inp", 3, 'c'),
        ];
        assert_eq!(seen, expect.map(|(f, l, c)| (f.to_string(), l, c)));
    }
}

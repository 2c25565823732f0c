//! First pass: lines to cards. Nodes, elements and members of sets go into compact arrays at once.

use std::io;

use crate::model::ElementKind;

use super::card::{Body, Card, Deck, Faces, Header, Members, parse_header};
use super::data::Lines;
use super::keywords::DataLines;
use super::lex::{self, ends_with_comma, fields, key, looks_numeric};
use super::members::FACE_REMEDY;
use super::other_table::defines_names_unseen;
use super::report::{At, Report, excerpt};
use super::source::{INCLUDE_DEPTH_MAX, INCLUDES_MAX, IncludeFault, LINE_BYTES_MAX, Line, Source};

/// Bytes of `*HEADING` that are kept.
const HEADING_BYTES_MAX: usize = 64 * 1024;

/// Largest coordinate: products of several must stay finite.
const COORDINATE_MAX: f64 = 1e60;

/// Reads every line of the deck.
pub fn collect(source: &mut Source<'_>, report: &mut Report) -> io::Result<Deck> {
    let mut collector =
        Collector { report, deck: Deck::default(), sink: Sink::BeforeFirst, row: ElementRow::default() };
    let mut buffer = Vec::with_capacity(256);
    while !collector.deck.stopped {
        let at = match source.next_line(&mut buffer)? {
            Line::Text(at) => at,
            Line::TooLong(at) => {
                collector.not_a_deck(at, format!("a line is longer than {LINE_BYTES_MAX} bytes"));
                break;
            }
            Line::End => break,
        };
        if buffer.contains(&0) || buffer.starts_with(b"\x1f\x8b") {
            collector.not_a_deck(at, binary_reason(&buffer).to_string());
            break;
        }
        let line = buffer.trim_ascii();
        if line.is_empty() || line.starts_with(b"**") {
            continue;
        }
        if line[0] != b'*' {
            collector.data_line(line, at);
            continue;
        }
        let header = join_continuations(source, line.to_vec())?;
        if let Some(input) = collector.keyword_line(&header, at)
            && let Err(fault) = source.include(&input)
        {
            collector.include_fault(&input, at, fault);
        }
    }
    collector.close_card();
    Ok(collector.deck)
}

/// Adds the lines that a trailing comma of a keyword line announces. A line that begins with a number is data all the same.
fn join_continuations(source: &mut Source<'_>, mut header: Vec<u8>) -> io::Result<Vec<u8>> {
    while ends_with_comma(&header) && header.len() < LINE_BYTES_MAX {
        let continues = match source.peek()? {
            None => false,
            Some(line) => {
                let line = line.trim_ascii();
                let comment = line.starts_with(b"**");
                comment || !(line.is_empty() || line.contains(&0) || line[0] == b'*' || looks_numeric(line))
            }
        };
        if !continues {
            break;
        }
        let mut buffer = Vec::new();
        source.next_line(&mut buffer)?;
        let line = buffer.trim_ascii();
        if !line.starts_with(b"**") {
            header.extend_from_slice(line);
        }
    }
    Ok(header)
}

/// Remedy for an element type that is not solved.
const ELEMENT_TYPES: &str = "C3D4, C3D6, C3D8, C3D8I, C3D8R, C3D10, C3D15, C3D20, C3D20R, T3D2, SPRINGA, SPRING1, SPRING2, DASHPOTA, DASHPOT1, DASHPOT2, MASS, ROTARYI, GAPUNI, GAPCYL, GAPSPHER, R3D3 and R3D4 are solved";

/// What to do about an element type that is not solved.
fn element_type_remedy(name: &str) -> &'static str {
    let begins = |prefixes: &[&str]| prefixes.iter().any(|prefix| name.starts_with(prefix));
    if begins(&["ISL", "IRS", "ITT"]) {
        "nodes slide along slide lines and tubes, and sliding is small here: describe the contact by *CONTACT PAIR"
    } else if begins(&["INTER"]) {
        "the contact of two faces is described by *CONTACT PAIR, that of two nodes by *GAP"
    } else if begins(&["DGAP", "DINTER"]) {
        "temperatures are not solved for: remove the elements"
    } else {
        ELEMENT_TYPES
    }
}

/// Kind of a type in upper case, as Abaqus means it.
fn element_kind(name: &str) -> Option<ElementKind> {
    // GAPUNIT has a temperature too, which nothing here acts on.
    let name = if name == "GAPUNIT" { "GAPUNI" } else { name };
    let mut kinds = ElementKind::SOLIDS.into_iter().chain(ElementKind::CONNECTORS).chain(ElementKind::INERT);
    kinds.find(|kind| kind.name() == name)
}

fn element_remedy(kind: ElementKind) -> String {
    match kind.node_count() {
        1 => "write: number, node".into(),
        2 => "write: number, node 1, node 2".into(),
        count => format!("write: number, node 1, …, node {count}"),
    }
}

fn binary_reason(line: &[u8]) -> &'static str {
    match line {
        [0x1f, 0x8b, ..] => "it is compressed by gzip; unpack it first",
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "it is UTF-16 text; save it as UTF-8",
        _ => "it is binary",
    }
}

/// Where data lines go.
enum Sink {
    /// No keyword yet.
    BeforeFirst,
    /// Nowhere.
    Skip,
    /// The keyword takes no data.
    Forbidden,
    Heading,
    Lines(Lines),
    Nodes,
    Elements(ElementKind),
    /// Elements of a type that is not supported: only their labels are noted.
    RefusedElements,
    Members(Members, Generate),
    /// A surface made of nodes.
    NodeFaces(Members),
    Faces(Faces),
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Generate {
    Yes,
    No,
}

/// Numbers of the element that is being read: its label, then its nodes.
#[derive(Default)]
struct ElementRow {
    numbers: Vec<u32>,
    at: Option<At>,
    bad: bool,
}

struct Collector<'r> {
    report: &'r mut Report,
    deck: Deck,
    sink: Sink,
    row: ElementRow,
}

impl Collector<'_> {
    fn not_a_deck(&mut self, at: At, why: String) {
        self.report.error(
            at,
            "",
            format!("this is not the text of a deck: {why}"),
            "give a text file in Abaqus format",
        );
        self.deck.incomplete = true;
        self.deck.stopped = true;
    }

    /// Returns the file to go on with when the line is `*INCLUDE`.
    fn keyword_line(&mut self, line: &[u8], at: At) -> Option<String> {
        let header = match std::str::from_utf8(line) {
            Ok(text) => parse_header(text, at, self.report),
            Err(_) => {
                let remedy = "save the file as UTF-8";
                self.report.error(at, &excerpt(line), "the line is not UTF-8 text", remedy);
                None
            }
        };
        let Some(header) = header else {
            self.close_card();
            self.sink = Sink::Skip;
            return None;
        };
        if header.keyword.name == "*INCLUDE" {
            return header.parameters.value("INPUT").map(str::to_string);
        }
        self.close_card();
        self.open_card(header, at);
        None
    }

    fn open_card(&mut self, header: Header, at: At) {
        let Header { keyword, parameters, faulty } = header;
        self.deck.incomplete |= defines_names_unseen(keyword);
        let mut body = Body::Nothing;
        self.sink = match keyword.data {
            DataLines::Forbidden => Sink::Forbidden,
            DataLines::Text if keyword.name == "*HEADING" => Sink::Heading,
            DataLines::Text | DataLines::Skipped => Sink::Skip,
            DataLines::Fields => Sink::Lines(Lines::default()),
            DataLines::Nodes => {
                let start = self.deck.nodes.labels.len() as u32;
                body = Body::Nodes(start..start);
                Sink::Nodes
            }
            DataLines::Elements => {
                let start = self.deck.elements.labels.len() as u32;
                body = Body::Elements(start..start);
                let kind = parameters.value("TYPE").unwrap_or("");
                if let Some(known) = element_kind(&key(kind)) {
                    Sink::Elements(known)
                } else {
                    if !kind.is_empty() {
                        let message = format!("element type {} is not supported", excerpt(kind.as_bytes()));
                        self.report.error(at, keyword.name, message, element_type_remedy(&key(kind)));
                    }
                    Sink::RefusedElements
                }
            }
            DataLines::Members => {
                let generate = if parameters.has("GENERATE") { Generate::Yes } else { Generate::No };
                Sink::Members(Members::default(), generate)
            }
            DataLines::Faces if parameters.word("TYPE") == "NODE" => Sink::NodeFaces(Members::default()),
            DataLines::Faces if matches!(parameters.word("TYPE").as_str(), "CYLINDER" | "REVOLUTION") => {
                Sink::Lines(Lines::default())
            }
            DataLines::Faces => Sink::Faces(Faces::default()),
        };
        self.deck.cards.push(Card { keyword, at, parameters, body, faulty });
    }

    /// Hands what was read to the card it belongs to.
    fn close_card(&mut self) {
        self.finish_element();
        let sink = std::mem::replace(&mut self.sink, Sink::Skip);
        let Some(card) = self.deck.cards.last_mut() else { return };
        match (sink, &mut card.body) {
            (Sink::Lines(lines), body) => *body = Body::Lines(lines),
            (Sink::Members(members, _) | Sink::NodeFaces(members), body) => *body = Body::Members(members),
            (Sink::Faces(faces), body) => *body = Body::Faces(faces),
            (_, Body::Nodes(range)) => range.end = self.deck.nodes.labels.len() as u32,
            (_, Body::Elements(range)) => range.end = self.deck.elements.labels.len() as u32,
            _ => {}
        }
    }

    /// Keyword of the present card.
    fn keyword(&self) -> &'static str {
        self.deck.cards.last().map_or("", |card| card.keyword.name)
    }

    fn data_line(&mut self, line: &[u8], at: At) {
        match &mut self.sink {
            Sink::Skip => {}
            Sink::Nodes => self.node_line(line, at),
            Sink::Elements(kind) => {
                let kind = *kind;
                self.element_line(line, at, kind);
            }
            Sink::RefusedElements => self.refused_element_line(line),
            Sink::Members(..) | Sink::NodeFaces(_) => self.member_line(line, at),
            Sink::Faces(_) => self.face_line(line, at),
            Sink::Lines(lines) => match std::str::from_utf8(line) {
                Ok(text) => lines.push(at, text),
                Err(_) => self.report.error(
                    at,
                    self.deck.cards.last().map_or("", |card| card.keyword.name),
                    "the line is not UTF-8 text",
                    "save the file as UTF-8",
                ),
            },
            Sink::Heading => {
                let heading = &mut self.deck.heading;
                if heading.len() + line.len() < HEADING_BYTES_MAX {
                    if !heading.is_empty() {
                        heading.push('\n');
                    }
                    heading.push_str(&String::from_utf8_lossy(line));
                }
            }
            Sink::Forbidden => {
                let remedy = "remove the line, or give it the keyword it belongs to";
                self.report.error(
                    at,
                    self.keyword(),
                    format!("the keyword takes no data lines: {}", excerpt(line)),
                    remedy,
                );
            }
            Sink::BeforeFirst => {
                let message = format!("text before the first keyword: {}", excerpt(line));
                self.report.error(at, "", message, "a deck begins with a keyword line such as *HEADING or *NODE");
            }
        }
    }

    fn node_line(&mut self, line: &[u8], at: At) {
        let mut row = fields(line);
        let label = lex::label(row.next().unwrap_or(b""));
        let mut coordinates = [0.0; 3];
        let mut fault = label.err().map(|fault| format!("node number {} {}", excerpt(line), fault.text()));
        let mut given = 0;
        for (coordinate, field) in coordinates.iter_mut().zip(&mut row) {
            given += 1;
            match lex::real(field) {
                Ok(value) if value.abs() <= COORDINATE_MAX => *coordinate = value,
                Ok(value) => {
                    fault = fault.or(Some(format!("coordinate {given}: {value} is out of any sensible range")))
                }
                Err(_) if field.is_empty() => {}
                Err(problem) => {
                    fault = fault.or(Some(format!("coordinate {given}: {} {}", excerpt(field), problem.text())))
                }
            }
        }
        if given == 0 {
            fault = fault.or(Some("the node has no coordinates".into()));
        }
        if let Some(message) = fault {
            self.report.error(at, "*NODE", message, "write: number, x, y, z");
            self.deck.refused_nodes.extend(label);
            return;
        }
        if row.next().is_some() {
            self.report.warning(
                at,
                "*NODE",
                "items behind the three coordinates are ignored",
                "write: number, x, y, z",
            );
        }
        if let Ok(label) = label {
            self.deck.nodes.labels.push(label);
            self.deck.nodes.coordinates.push(coordinates);
            self.deck.nodes.at.push(at);
        }
    }

    fn element_line(&mut self, line: &[u8], at: At, kind: ElementKind) {
        let row = &mut self.row;
        row.at.get_or_insert(at);
        for field in fields(line) {
            match lex::label(field) {
                Ok(number) => row.numbers.push(number),
                Err(fault) if !row.bad => {
                    let what = if row.numbers.is_empty() { "element number" } else { "node number" };
                    let message = format!("{what} {} {}", excerpt(field), fault.text());
                    self.report.error(at, "*ELEMENT", message, element_remedy(kind));
                    row.bad = true;
                }
                Err(_) => {}
            }
        }
        if row.numbers.len() > kind.node_count() || !ends_with_comma(line) {
            self.finish_element();
        }
    }

    /// Stores the element that is being read, complete or not.
    fn finish_element(&mut self) {
        let row = std::mem::take(&mut self.row);
        let (Some(at), elements) = (row.at, &mut self.deck.elements) else { return };
        if let (Some((&label, nodes)), Sink::Elements(kind), false) = (row.numbers.split_first(), &self.sink, row.bad) {
            let (kind, count) = (*kind, kind.node_count());
            if nodes.len() == count {
                elements.labels.push(label);
                elements.kinds.push(kind);
                elements.nodes.extend_from_slice(nodes);
                elements.at.push(at);
                self.row.numbers = row.numbers;
                self.row.numbers.clear();
                return;
            }
            let message = format!("element {label} has {} nodes; {} has {count}", nodes.len(), kind.name());
            let remedy = format!("{}; a comma at the end continues the line", element_remedy(kind));
            self.report.error(at, "*ELEMENT", message, remedy);
        }
        self.deck.refused_elements.extend(row.numbers.first());
    }

    fn refused_element_line(&mut self, line: &[u8]) {
        if self.row.at.is_none() {
            self.deck.refused_elements.extend(fields(line).next().and_then(|field| lex::label(field).ok()));
        }
        self.row.at = None;
        if ends_with_comma(line) {
            self.row = ElementRow { numbers: Vec::new(), at: Some(At::DECK), bad: true };
        }
    }

    fn member_line(&mut self, line: &[u8], at: At) {
        let mut faults: Vec<(String, &str)> = Vec::new();
        match &mut self.sink {
            Sink::Members(members, Generate::Yes) => {
                faults.extend(
                    members.add_range(line, at).err().map(|message| (message, "write: first, last, increment")),
                );
            }
            Sink::Members(members, Generate::No) => {
                for field in fields(line).filter(|field| !field.is_empty()) {
                    let remedy = "write numbers and names of sets, separated by commas";
                    faults.extend(members.add(field, at).err().map(|message| (message, remedy)));
                }
            }
            Sink::NodeFaces(members) => {
                let mut row = fields(line);
                let remedy = "write the number of a node or the name of a node set";
                faults.extend(members.add(row.next().unwrap_or(b""), at).err().map(|message| (message, remedy)));
                if let Some(area) = row.find(|field| !field.is_empty()) {
                    let message = format!("an area per node is not read here: {}", excerpt(area));
                    faults.push((message, "give the area on the data line of *SURFACE INTERACTION"));
                }
            }
            _ => {}
        }
        self.member_faults(at, faults);
    }

    fn face_line(&mut self, line: &[u8], at: At) {
        let Sink::Faces(faces) = &mut self.sink else { return };
        let mut row = fields(line);
        let (region, face) = (row.next().unwrap_or(b""), row.next().unwrap_or(b""));
        let mut faults: Vec<(String, &str)> = faces.add(region, face, at).err().into_iter().collect();
        if let Some(extra) = row.find(|field| !field.is_empty()) {
            faults.push((format!("the item behind the face is not read: {}", excerpt(extra)), FACE_REMEDY));
        }
        self.member_faults(at, faults);
    }

    fn member_faults(&mut self, at: At, faults: Vec<(String, &str)>) {
        let Some(card) = self.deck.cards.last_mut() else { return };
        for (message, remedy) in faults {
            self.report.error(at, card.keyword.name, message, remedy);
            card.faulty = true;
        }
    }

    fn include_fault(&mut self, input: &str, at: At, fault: IncludeFault) {
        // What the file would have defined is unknown: complaints about missing names would mislead.
        self.deck.incomplete |= !matches!(fault, IncludeFault::Cycle);
        self.deck.stopped |= matches!(fault, IncludeFault::TooMany);
        let input = excerpt(input.as_bytes());
        let (message, remedy) = match fault {
            IncludeFault::NoFolder => (
                format!("{input} cannot be included: this text came without a folder"),
                "put the lines of the file in its place".to_string(),
            ),
            IncludeFault::Cycle => (format!("{input} includes itself"), "remove one of the *INCLUDE lines".to_string()),
            IncludeFault::TooDeep => (
                format!("{input} is included more than {INCLUDE_DEPTH_MAX} files deep"),
                "include it from the deck itself".to_string(),
            ),
            IncludeFault::TooMany => {
                (format!("more than {INCLUDES_MAX} files are included"), "join the files".to_string())
            }
            IncludeFault::Unreadable(path, error) => (
                format!("{} cannot be read: {error}", path.display()),
                "names are relative to the folder of the including file".to_string(),
            ),
        };
        self.report.error(at, "*INCLUDE", message, remedy);
    }
}

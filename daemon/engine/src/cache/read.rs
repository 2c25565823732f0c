//! Reading a prepared model.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use serde::de::DeserializeOwned;

use super::{BUILD, HEADER, MAGIC, VERSION};
use crate::solve::lazy::LazyFactor;
use crate::solve::linear::{Blocks, Factor};

/// Bytes asked of the system at a time.
const BLOCK: usize = 1 << 20;
/// More sections than any model has bodies that were factored.
const SECTIONS_MAX: usize = 1 << 20;

/// Why a file is passed over.
#[derive(Debug, thiserror::Error)]
pub enum Refused {
    /// There is none.
    #[error("there is no such file")]
    Absent,
    /// It is in order, but of something else.
    #[error("it belongs to {0}")]
    Other(&'static str),
    /// It is not what was written.
    #[error("it is damaged: {0}")]
    Damaged(String),
    /// The system does not let it be read.
    #[error("it cannot be read: {0}")]
    Unreadable(#[from] io::Error),
}

/// Reads what was kept of the bodies and finds their factors; the first result is the length of the file.
pub fn open<T: DeserializeOwned>(path: &Path, key: u64) -> Result<(u64, T, Vec<LazyFactor>), Refused> {
    let mut file = match File::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Err(Refused::Absent),
        Err(error) => return Err(error.into()),
    };
    let lengths = read_header(&mut file, key)?;
    let file = Arc::new(StoredFile { path: path.to_owned(), file: Mutex::new(file) });
    let mut offset = (HEADER + 8 * lengths.len() + 4) as u64;
    let mut sections = Vec::with_capacity(lengths.len());
    for length in lengths {
        sections.push(Section { file: Arc::clone(&file), offset, length });
        offset += length + 4;
    }
    let mut sections = sections.into_iter();
    let first = sections.next().ok_or_else(|| damaged("it has no sections"))?;
    let bodies = first.read_bodies()?;
    Ok((offset, bodies, sections.map(Section::into_lazy).collect()))
}

fn damaged(detail: &str) -> Refused {
    Refused::Damaged(detail.into())
}

/// Checks the header and the length of the file; the lengths of the sections.
fn read_header(file: &mut File, key: u64) -> Result<Vec<u64>, Refused> {
    let total = file.metadata()?.len();
    let mut bytes = vec![0; HEADER];
    read_all(file, &mut bytes)?;
    let word = |bytes: &[u8], at: usize| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
    let long = |bytes: &[u8], at: usize| u64::from(word(bytes, at)) | u64::from(word(bytes, at + 4)) << 32;
    if bytes[..4] != MAGIC {
        return Err(damaged("it does not begin with OVPM"));
    }
    if word(&bytes, 4) != VERSION {
        return Err(Refused::Other("another version of the file format"));
    }
    let sections = word(&bytes, 24) as usize;
    if sections > SECTIONS_MAX {
        return Err(damaged("its number of sections is absurd"));
    }
    bytes.resize(HEADER + 8 * sections + 4, 0);
    read_all(file, &mut bytes[HEADER..])?;
    let end = HEADER + 8 * sections;
    if word(&bytes, end) != crc32fast::hash(&bytes[..end]) {
        return Err(damaged("the checksum of its header does not match"));
    }
    if long(&bytes, 8) != BUILD {
        return Err(Refused::Other("another build of the engine"));
    }
    if long(&bytes, 16) != key {
        return Err(Refused::Other("another model"));
    }
    let lengths: Vec<u64> = (0..sections).map(|i| long(&bytes, HEADER + 8 * i)).collect();
    let expected = lengths.iter().try_fold(end as u64 + 4, |sum, l| sum.checked_add(*l)?.checked_add(4));
    if expected != Some(total) {
        return Err(Refused::Damaged(format!("it has {total} bytes, not {}", expected.unwrap_or(u64::MAX))));
    }
    Ok(lengths)
}

/// A file that ends early is damaged, not unreadable.
fn read_all(reader: &mut impl Read, bytes: &mut [u8]) -> Result<(), Refused> {
    reader.read_exact(bytes).map_err(|error| match error.kind() {
        io::ErrorKind::UnexpectedEof => damaged("it ends early"),
        _ => Refused::Unreadable(error),
    })
}

struct StoredFile {
    path: PathBuf,
    file: Mutex<File>,
}

/// A part of a file that stays open: what happens to its name no longer matters.
struct Section {
    file: Arc<StoredFile>,
    offset: u64,
    length: u64,
}

impl Section {
    /// The factor that it holds, to be read when it is needed.
    fn into_lazy(self) -> LazyFactor {
        LazyFactor::stored(Box::new(move |unknowns| {
            self.read_factor(unknowns).map_err(|refused| {
                let path = self.file.path.display();
                format!("that in {path} cannot be used: {refused}; delete the file to have it written anew")
            })
        }))
    }

    fn read_bodies<T: DeserializeOwned>(&self) -> Result<T, Refused> {
        self.read(|reader| {
            let mut bytes = vec![0; self.length as usize];
            reader.take(&mut bytes)?;
            Ok(bytes)
        })
        .and_then(|bytes| decode(&bytes))
    }

    /// Reads a factor and checks it.
    fn read_factor(&self, unknowns: usize) -> Result<Factor, Refused> {
        let (structure, values) = self.read(|reader| {
            let mut word = [0; 8];
            reader.take(&mut word)?;
            let length = u64::from_le_bytes(word);
            let rest = self.length.checked_sub(8).and_then(|l| l.checked_sub(length));
            let rest = rest.filter(|r| r % 8 == 0).ok_or_else(|| damaged("the length of a factor does not fit"))?;
            let mut structure = vec![0; length as usize];
            reader.take(&mut structure)?;
            Ok((structure, reader.take_numbers((rest / 8) as usize)?))
        })?;
        let blocks: Blocks = decode(&structure)?;
        let of_this_size = |factor: &Factor| factor.blocks().unknowns() == unknowns;
        Factor::from_parts(blocks, values)
            .filter(of_this_size)
            .ok_or_else(|| damaged("the structure of a factor contradicts itself"))
    }

    /// Reads the section by `take` and compares its checksum.
    fn read<R>(&self, take: impl FnOnce(&mut Checked<'_>) -> Result<R, Refused>) -> Result<R, Refused> {
        let mut file = self.file.file.lock().expect("readers of the file do not panic");
        file.seek(SeekFrom::Start(self.offset))?;
        let mut reader = Checked { file: &mut file, crc: crc32fast::Hasher::new() };
        let result = take(&mut reader)?;
        let crc = reader.crc.finalize();
        let mut stored = [0; 4];
        read_all(&mut *file, &mut stored)?;
        if crc != u32::from_le_bytes(stored) {
            return Err(damaged("a checksum does not match"));
        }
        Ok(result)
    }
}

fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, Refused> {
    match postcard::take_from_bytes(bytes) {
        Ok((value, [])) => Ok(value),
        _ => Err(damaged("a section cannot be decoded")),
    }
}

/// A reader that knows the checksum of what it has given.
struct Checked<'a> {
    file: &'a mut File,
    crc: crc32fast::Hasher,
}

impl Checked<'_> {
    fn take(&mut self, bytes: &mut [u8]) -> Result<(), Refused> {
        read_all(self.file, bytes)?;
        self.crc.update(bytes);
        Ok(())
    }

    fn take_numbers(&mut self, count: usize) -> Result<Vec<f64>, Refused> {
        let mut values = Vec::with_capacity(count);
        let mut bytes = vec![0; BLOCK.min(8 * count)];
        while values.len() < count {
            let part = &mut bytes[..BLOCK.min(8 * (count - values.len()))];
            self.take(part)?;
            let (words, _) = part.as_chunks::<8>();
            values.extend(words.iter().map(|w| f64::from_le_bytes(*w)));
        }
        Ok(values)
    }
}

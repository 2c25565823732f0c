//! `ports.toml`: renames, selects and documents ports.
//!
//! ```toml
//! select = "listed"              # "all" (default) keeps the ports that are not listed
//!
//! [[port]]
//! port = "boundary.NTOP.3"       # name that the deck gives
//! name = "punch_depth"           # new name, optional
//! unit = "mm"                    # optional
//! description = "Depth of the punch"
//! ```

use serde::Deserialize;

use crate::outputs::Source;
use crate::port::{Port, PortList};

/// A parsed `ports.toml`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PortConfig {
    #[serde(default)]
    select: Select,
    #[serde(default, rename = "port")]
    entries: Vec<Entry>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Select {
    #[default]
    All,
    Listed,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    port: String,
    name: Option<String>,
    unit: Option<String>,
    description: Option<String>,
}

impl PortConfig {
    /// Reads the text; the error names line and key.
    pub fn parse(text: &str) -> Result<Self, Vec<String>> {
        toml::from_str(text).map_err(|e| vec![e.to_string().trim().replace('\n', " ")])
    }

    /// Applies the file to the ports of a deck. Inputs that are not selected keep following the deck, so only outputs
    /// are dropped by `select`; an input that is not listed stays available under its own name.
    pub fn apply(&self, ports: PortList, sources: &[Source]) -> Result<(PortList, Vec<Source>), Vec<String>> {
        let mut errors = Vec::new();
        for (i, entry) in self.entries.iter().enumerate() {
            if ports.input(&entry.port).is_none() && ports.output(&entry.port).is_none() {
                let near =
                    ports.inputs.iter().chain(&ports.outputs).map(|p| p.name.as_str()).collect::<Vec<_>>().join(", ");
                errors.push(format!("port {:?} does not exist; this deck has {near}", entry.port));
            }
            if self.entries[..i].iter().any(|e| e.port == entry.port) {
                errors.push(format!("port {:?} is listed twice", entry.port));
            }
        }
        let entry_of = |p: &Port| self.entries.iter().find(|e| e.port == p.name);
        let rewrite = |p: Port| match entry_of(&p) {
            None => p,
            Some(e) => Port {
                name: e.name.clone().unwrap_or(p.name),
                quantity: p.quantity,
                unit: e.unit.clone().or(p.unit),
                description: e.description.clone().unwrap_or(p.description),
            },
        };
        let keep = |p: &Port| self.select == Select::All || entry_of(p).is_some();
        let (kept, kept_sources): (Vec<Port>, Vec<Source>) =
            ports.outputs.into_iter().zip(sources.iter().copied()).filter(|(p, _)| keep(p)).unzip();
        let out = PortList {
            inputs: ports.inputs.into_iter().map(rewrite).collect(),
            outputs: kept.into_iter().map(rewrite).collect(),
        };
        let mut names: Vec<&str> = out.inputs.iter().chain(&out.outputs).map(|p| p.name.as_str()).collect();
        names.sort_unstable();
        for pair in names.windows(2).filter(|w| w[0] == w[1]) {
            errors.push(format!("two ports would be named {:?}", pair[0]));
        }
        if errors.is_empty() { Ok((out, kept_sources)) } else { Err(errors) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::port::Quantity;

    fn ports() -> PortList {
        let port =
            |name: &str| Port { name: name.into(), quantity: Quantity::Force, unit: None, description: "d".into() };
        PortList { inputs: vec![port("in")], outputs: vec![port("a"), port("b")] }
    }

    #[test]
    fn listed_outputs_are_renamed_and_the_rest_dropped() {
        let config = PortConfig::parse("select='listed'\n[[port]]\nport='b'\nname='force'\nunit='N'\n").expect("valid");
        let (out, sources) = config.apply(ports(), &[Source::Increments, Source::Cutbacks]).expect("consistent");
        assert_eq!(out.inputs.len(), 1);
        assert_eq!((out.outputs[0].name.as_str(), out.outputs[0].unit.as_deref()), ("force", Some("N")));
        assert_eq!(sources, vec![Source::Cutbacks]);
    }

    #[test]
    fn unknown_ports_clashes_and_unknown_keys_are_refused() {
        let clash = PortConfig::parse("[[port]]\nport='b'\nname='a'\n[[port]]\nport='zz'\n").expect("valid toml");
        let errors = clash.apply(ports(), &[Source::Increments, Source::Cutbacks]).expect_err("refused");
        assert_eq!(errors.len(), 2, "{errors:?}");
        assert!(PortConfig::parse("colour = 1").is_err());
    }
}

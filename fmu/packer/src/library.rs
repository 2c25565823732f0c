//! Where the FMU library is.

use std::path::{Path, PathBuf};

/// File name of the library.
const FILE: &str = "liboverclosure_fmu.so";

/// Environment variable that names the library, or the folder that it is in.
pub const LIBRARY_VARIABLE: &str = "OVERCLOSURE_FMU_LIB";

/// Looks beside the executable, then in `../lib/overclosure` seen from it, then where [`LIBRARY_VARIABLE`] says.
/// Otherwise the places that were tried.
pub fn find_library(executable: &Path, named: Option<&Path>) -> Result<PathBuf, Vec<String>> {
    let folder = executable.parent().unwrap_or(Path::new("."));
    let beside = folder.join(FILE);
    let installed = folder.join("../lib/overclosure").join(FILE);
    let named_file = named.map(|path| if path.is_dir() { path.join(FILE) } else { path.to_path_buf() });
    let places = [Some(beside), Some(installed), named_file];
    if let Some(found) = places.iter().flatten().find(|path| path.is_file()) {
        return Ok(found.clone());
    }
    Err(places
        .into_iter()
        .map(|place| match place {
            Some(path) => path.display().to_string(),
            None => format!("the file named by {LIBRARY_VARIABLE} (not set)"),
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn the_three_places_are_tried_in_order() {
        let root = tempfile::tempdir().expect("folder");
        let bin = root.path().join("bin");
        let lib = root.path().join("lib/overclosure");
        for folder in [&bin, &lib] {
            fs::create_dir_all(folder).expect("folder");
        }
        let executable = bin.join("overclosure");
        let named = root.path().join("elsewhere.so");
        assert_eq!(find_library(&executable, Some(&named)).expect_err("nowhere").len(), 3);
        fs::write(&named, "").expect("write");
        assert_eq!(find_library(&executable, Some(&named)).expect("named"), named);
        fs::write(lib.join(FILE), "").expect("write");
        assert!(
            find_library(&executable, Some(&named))
                .expect("installed")
                .ends_with("lib/overclosure/liboverclosure_fmu.so")
        );
        fs::write(bin.join(FILE), "").expect("write");
        assert_eq!(find_library(&executable, Some(&named)).expect("beside"), bin.join(FILE));
    }
}

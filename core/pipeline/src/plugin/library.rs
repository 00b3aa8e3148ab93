//! Loading a plugin: the file, the handshake, the stage tables.

use super::card::{Strides, read};
use super::first_bytes;
use super::foreign::ForeignType;
use super::loaded::LoadedLibrary;
use super::refused_by_system::worded;
use super::whole::check_whole;
use libloading::Library;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use tempfile::NamedTempFile;
use toile_core::artifact::Digest;
use toile_core::param::Check;
use toile_core::plugin::inside::long;
use toile_core::plugin::view::text;
use toile_core::plugin::{Make, Plugin, Refused, abi};
use toile_core::text::intern;
use toile_core::{Card, NoFile, PluginId, Registry, read_file};

/// What every entry symbol begins with.
const SYMBOL: &[u8] = b"toile_plugin";
/// The most stages of one plugin.
const MAX_STAGES: usize = 1000;

/// Loads a plugin and adds its stages to the registry, all or none; `pinned` is the BLAKE3 digest
/// that its file must have.
///
/// Errors: why it is refused; a refused plugin stays listed with its reason.
pub fn load_plugin(registry: &mut Registry, path: &Path, pinned: Option<&str>) -> Result<(), Refused> {
    let loaded = load(path, pinned, registry.loads_apart());
    registry.add_plugin(path, loaded)
}

/// The files that a plugin's name may mean: the name itself, and dressed as the system names
/// libraries.
pub fn plugin_files(path: &Path) -> [PathBuf; 2] {
    let (prefix, suffix) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let stem = path.file_name().map(|n| n.to_string_lossy().replace('-', "_")).unwrap_or_default();
    [path.to_owned(), path.with_file_name(format!("{prefix}{stem}{suffix}"))]
}

/// The library of a crate that is named after its stage, as `toile new-stage` names it:
/// `libmy_otsu.so` of `MyOtsu`.
pub fn library_of(stage: &str) -> String {
    let mut name = String::new();
    for (i, c) in stage.char_indices() {
        name.push_str(if i > 0 && c.is_ascii_uppercase() { "_" } else { "" });
        name.push(c.to_ascii_lowercase());
    }
    format!("{}{name}{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX)
}

/// The first of those that is there; the name itself where none is.
fn found(path: &Path) -> PathBuf {
    let files = plugin_files(path);
    files.iter().find(|f| f.is_file()).unwrap_or(&files[0]).clone()
}

/// Loads a plugin; `pinned` is the BLAKE3 digest in hexadecimal that its file must have.
///
/// Loading runs the library's own initialisation: a plugin is code that the user trusts.
///
/// With `apart` a copy is loaded, so that the file may be replaced or written over while this
/// program goes on.
///
/// Errors: why it is refused. A file that is no whole library for this machine, or not the pinned
/// one, is never loaded.
pub fn load(path: &Path, pinned: Option<&str>, apart: bool) -> Result<Plugin, Refused> {
    let file = found(path);
    let refused =
        |(reason, hint): (String, Option<String>)| Refused { file: path.display().to_string(), reason, hint };
    let bytes = bytes(&file).map_err(refused)?;
    let digest = Digest::of(&bytes);
    check_pin(&digest, pinned).map_err(refused)?;
    if let Some((reason, hint)) = first_bytes::foreign(&bytes) {
        return Err(refused((reason, Some(hint))));
    }
    check_whole(&bytes).map_err(|why| {
        let hint = "an interrupted build or copy leaves such a file: build it again".to_owned();
        refused((format!("the system cannot load it: {why}"), Some(hint)))
    })?;
    let symbols = symbols(&bytes);
    if symbols.is_empty() {
        let hint = "a plugin exports `toile_plugin`; see docs/reference/plugin-abi.md".to_owned();
        return Err(refused(("it declares no plugin".into(), Some(hint))));
    }
    // A bare name would be looked for in the system's folders.
    let full = std::fs::canonicalize(&file).map_err(|e| refused(plain(words(&e))))?;
    let copy = (replaced(&full, digest) || apart).then(|| copy(&bytes)).transpose().map_err(refused)?;
    drop(bytes);
    let _inside = long(intern(&format!("the plugin \"{}\"", path.display())), "while it is loaded");
    let from = copy.as_ref().map_or(full.as_path(), |copy| copy.path());
    let mut plugin = unsafe { open((from, &full), &symbols, digest) }.map_err(refused)?;
    plugin.file = full;
    Ok(plugin)
}

/// Whether this program has loaded another library from the same path: the system would give it
/// again.
fn replaced(path: &Path, digest: Digest) -> bool {
    static LOADED: Mutex<BTreeMap<PathBuf, Digest>> = Mutex::new(BTreeMap::new());
    let mut loaded = LOADED.lock().unwrap_or_else(PoisonError::into_inner);
    *loaded.entry(path.to_owned()).or_insert(digest) != digest
}

/// A copy of a library that is gone from its folder once it is loaded.
fn copy(bytes: &[u8]) -> Result<NamedTempFile, Why> {
    let fault = |e: std::io::Error| {
        plain(format!("no copy of it can be made in the folder for temporary files: {}", words(&e)))
    };
    let mut file = tempfile::Builder::new()
        .prefix("toile-plugin-")
        .suffix(std::env::consts::DLL_SUFFIX)
        .tempfile()
        .map_err(fault)?;
    file.write_all(bytes).map_err(fault)?;
    Ok(file)
}

type Why = (String, Option<String>);

fn plain(reason: impl Into<String>) -> Why {
    (reason.into(), None)
}

fn bytes(file: &Path) -> Result<Vec<u8>, Why> {
    let hint =
        || Some("build it first, and name the library, like target/release/libtoile_sdf.so".to_owned());
    read_file(file).map_err(|e| {
        let no_file = e.get_ref().is_some_and(|inner| inner.is::<NoFile>());
        (words(&e), (no_file || e.kind() == std::io::ErrorKind::NotFound).then(hint).flatten())
    })
}

fn words(e: &std::io::Error) -> String {
    match e.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".into(),
        std::io::ErrorKind::PermissionDenied => "permission denied".into(),
        _ => e.to_string(),
    }
}

fn check_pin(digest: &Digest, pinned: Option<&str>) -> Result<(), Why> {
    match pinned {
        Some(pin) if !pin.eq_ignore_ascii_case(&digest.hex()) => {
            let hint = "it was built anew, or is not the file that was tested: look, then pin the new digest";
            Err((format!("its digest is {}, pinned is {pin}", digest.hex()), Some(hint.into())))
        }
        _ => Ok(()),
    }
}

/// The names in a file that may be a plugin's declaration: each library has its own, so that
/// several may be linked into one program, and a renamed file is still known.
fn symbols(bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(i) = find(&bytes[at..], SYMBOL) {
        let from = at + i;
        let name = |c: &u8| c.is_ascii_alphanumeric() || *c == b'_';
        let end = from + bytes[from..].iter().take_while(|c| name(c)).count();
        let whole = bytes.get(end) == Some(&0) && (from == 0 || matches!(bytes[from - 1], 0 | b'_'));
        let symbol = [&bytes[from..end], b"\0"].concat();
        if whole && end - from <= 200 && !found.contains(&symbol) && found.len() < 64 {
            found.push(symbol);
        }
        at = from + SYMBOL.len();
    }
    found
}

fn find(bytes: &[u8], what: &[u8]) -> Option<usize> {
    let mut at = 0;
    loop {
        let i = at + bytes.get(at..)?.iter().position(|b| *b == what[0])?;
        if bytes[i..].starts_with(what) {
            return Some(i);
        }
        at = i + 1;
    }
}

/// Opens a library with all functions that it calls: one that is not there would end the program
/// where it is called first.
///
/// # Safety
/// The library is trusted to obey the rules of the border.
#[cfg(unix)]
unsafe fn opened(file: &Path) -> Result<Library, libloading::Error> {
    use libloading::os::unix::{Library as Opened, RTLD_LOCAL, RTLD_NOW};
    unsafe { Opened::open(Some(file), RTLD_NOW | RTLD_LOCAL) }.map(Library::from)
}

/// Opens a library; this system looks for all functions at once.
///
/// # Safety
/// The library is trusted to obey the rules of the border.
#[cfg(not(unix))]
unsafe fn opened(file: &Path) -> Result<Library, libloading::Error> {
    unsafe { Library::new(file) }
}

/// Loads `file`, or its copy where it is loaded `from` one.
///
/// # Safety
/// The library is trusted to obey the rules of the border.
unsafe fn open((from, file): (&Path, &Path), symbols: &[Vec<u8>], digest: Digest) -> Result<Plugin, Why> {
    let library = unsafe { opened(from) }.map_err(|e| worded(&e, from, file))?;
    let declared = symbols
        .iter()
        .find_map(|s| unsafe { library.get::<*const abi::Declaration>(s.as_slice()) }.ok().map(|d| *d));
    let declared = declared.ok_or_else(|| plain("it declares no plugin"))?;
    let declaration = unsafe { handshake(declared)? };
    let name = unsafe { text(declaration.name) }.map_err(plain)?;
    let version = unsafe { text(declaration.version) }.map_err(plain)?;
    let fit = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.' | '+');
    if name.is_empty() || name.len() > 64 || !name.chars().chain(version.chars()).all(fit) {
        return Err(plain(format!(
            "\"{}\" {} is no name and version",
            name.escape_debug(),
            version.escape_debug()
        )));
    }
    let id = PluginId { name: intern(name), version: intern(version), digest };
    let words = intern(&format!("plugin \"{}\" {}", id.name, id.version));
    let loaded = Arc::new(LoadedLibrary::new(id, words, library));
    let (cards, makers) = unsafe { stages(&declaration, &loaded)? };
    Ok(Plugin { id, file: file.to_owned(), abi: (declaration.major, declaration.minor), cards, makers })
}

/// Checks a declaration before anything in it is called.
unsafe fn handshake(declared: *const abi::Declaration) -> Result<abi::Declaration, Why> {
    if declared.is_null() || !declared.is_aligned() {
        return Err(plain("its declaration lies at no proper address"));
    }
    // The first fields are those of every version.
    let magic = unsafe { (&raw const (*declared).magic).read() };
    if magic != abi::MAGIC {
        return Err(plain("its declaration does not begin with TOILEPLG"));
    }
    let (major, minor) = unsafe { ((*declared).major, (*declared).minor) };
    if major != abi::MAJOR || minor > abi::MINOR {
        let spoken = format!(
            "it speaks ABI {major}.{minor}, this program speaks {0}.0 to {0}.{1}",
            abi::MAJOR,
            abi::MINOR
        );
        let hint = if (major, minor) > (abi::MAJOR, abi::MINOR) {
            "use a newer toile"
        } else {
            "build it anew with the present SDK"
        };
        return Err((spoken, Some(hint.into())));
    }
    let size = unsafe { (*declared).size };
    if (size as usize) < size_of::<abi::Declaration>() {
        return Err(short("its declaration has", size, size_of::<abi::Declaration>()));
    }
    let d = unsafe { declared.read() };
    let least = if minor == 0 { abi::STAGE_SIZE_1_0 as usize } else { size_of::<abi::StageTable>() };
    fits("its stage tables have", d.stage_size, least)?;
    fits("its parameters have", d.param_size, size_of::<abi::Param>())?;
    fits("its ports have", d.port_size, size_of::<abi::Port>())?;
    Ok(d)
}

fn fits(what: &str, size: u32, least: usize) -> Result<(), Why> {
    match size as usize >= least && size.is_multiple_of(8) && size <= 1 << 16 {
        true => Ok(()),
        false => Err(short(what, size, least)),
    }
}

fn short(what: &str, size: u32, least: usize) -> Why {
    let hint = "it was built against a damaged or foreign header".to_owned();
    (format!("{what} {size} bytes, at least {least} are needed"), Some(hint))
}

type Makers = Vec<Arc<dyn Make>>;

/// # Safety
/// The declaration has passed the handshake.
unsafe fn stages(d: &abi::Declaration, library: &Arc<LoadedLibrary>) -> Result<(Vec<Card>, Makers), Why> {
    let list = d.stages.ok_or_else(|| plain("it lacks the function `stages`"))?;
    let mut count = 0;
    let first = unsafe { list(&mut count) };
    if count == 0 || count > MAX_STAGES {
        return Err(plain(format!("it lists {count} stages, 1 to {MAX_STAGES} are possible")));
    }
    if first.is_null() || !first.cast::<abi::StageTable>().is_aligned() {
        return Err(plain("its stage tables lie at no proper address"));
    }
    let strides = Strides { param: d.param_size as usize, port: d.port_size as usize };
    let (mut cards, mut makers): (_, Makers) = (Vec::new(), Vec::new());
    for i in 0..count {
        let at = unsafe { first.byte_add(i * d.stage_size as usize) };
        let of = ForeignType { library: library.clone(), table: unsafe { whole(at, d.stage_size) } };
        let card = unsafe { card_of(&of, strides, library.id()) }.map_err(plain)?;
        if cards.iter().any(|c: &Card| c.name == card.name) {
            return Err(plain(format!("it has two stages named `{}`", card.name)));
        }
        cards.push(card);
        makers.push(Arc::new(of));
    }
    Ok((cards, makers))
}

/// A table of which only the first bytes may be there; the rest reads as null.
unsafe fn whole(at: *const std::ffi::c_void, size: u32) -> abi::StageTable {
    let mut table = std::mem::MaybeUninit::<abi::StageTable>::zeroed();
    let known = (size as usize).min(size_of::<abi::StageTable>());
    // Every field of a table may be zero: numbers, null pointers, absent functions.
    unsafe {
        std::ptr::copy_nonoverlapping(at.cast::<u8>(), table.as_mut_ptr().cast::<u8>(), known);
        table.assume_init()
    }
}

unsafe fn card_of(of: &ForeignType, strides: Strides, id: PluginId) -> Result<Card, String> {
    let check = |param: usize| {
        let of = of.clone();
        of.table.check.is_some().then(|| Check::by(move |value, doc| of.check(param, value, doc)))
    };
    let card = unsafe { read(&of.table, strides, id, check)? };
    let lacks = |what: &str| Err(format!("its stage `{}` lacks the function `{what}`", card.name));
    match (of.table.create, of.table.run, of.table.destroy) {
        (None, ..) => lacks("create"),
        (_, None, _) => lacks("run"),
        (.., None) => lacks("destroy"),
        _ => Ok(card),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_are_found_by_name_in_the_file() {
        let file = b"\x7fELF\0toile_plugin\0x\0toile_plugin_sdf\0mytoile_plugin\0toile_plugin-no\0_toile_plugin_mac\0";
        let found = symbols(file);
        let words: Vec<_> = found.iter().map(|s| String::from_utf8_lossy(s).into_owned()).collect();
        assert_eq!(words, ["toile_plugin\0", "toile_plugin_sdf\0", "toile_plugin_mac\0"]);
    }
}

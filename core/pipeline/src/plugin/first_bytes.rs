//! What a file is that is named as a plugin and is none for this machine, told by its first bytes:
//! a library for another system or another processor, a program, an archive, a text.
//!
//! The system's own words for such a file are "invalid ELF header" at best. Source: System V ABI,
//! chapter 4 (ELF); PE Format; Mach-O Programming Topics. Cost: a look at some hundred bytes.
//! Limit: what is damaged beyond these is left to `whole` and to the system.

use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};

/// Why a file cannot be a plugin here, and what the user may do.
type MisfitReason = (String, String);

/// The longest first line of a text that is shown, characters.
const MOST_SHOWN: usize = 40;

/// Looks at a file; none where it may be a library for this machine.
pub(super) fn foreign(bytes: &[u8]) -> Option<MisfitReason> {
    match bytes {
        [] => Some((
            "it is empty".into(),
            "an interrupted build or copy leaves such a file: build it again".into(),
        )),
        [0x7F, b'E', b'L', b'F', ..] => found(elf(bytes)?, OperatingSystem::Linux),
        [b'M', b'Z', ..] => found(pe(bytes)?, OperatingSystem::Windows),
        [0xCF | 0xCE, 0xFA, 0xED, 0xFE, ..] => found(mach(bytes)?, OperatingSystem::MacOs),
        // Java classes begin alike; their count reads as one beyond any.
        [0xCA, 0xFE, 0xBA, 0xBE | 0xBF, 0, 0, 0, 1..=16, ..] => {
            found(Code { form: FileForm::Library, processors: fat(bytes) }, OperatingSystem::MacOs)
        }
        _ => Some(other(bytes)),
    }
}

/// What code a file holds.
struct Code {
    form: FileForm,
    processors: Vec<String>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum FileForm {
    Library,
    Program,
    Object,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum OperatingSystem {
    Linux,
    MacOs,
    Windows,
}

impl OperatingSystem {
    /// That whose libraries this machine loads; systems that are none of these load those of
    /// Linux's form.
    fn here() -> Self {
        match OS {
            "windows" => OperatingSystem::Windows,
            "macos" | "ios" => OperatingSystem::MacOs,
            _ => OperatingSystem::Linux,
        }
    }

    fn name(self) -> &'static str {
        match self {
            OperatingSystem::Linux => "Linux",
            OperatingSystem::MacOs => "macOS",
            OperatingSystem::Windows => "Windows",
        }
    }
}

/// Code of that system: what is wrong with it here.
fn found(code: Code, system: OperatingSystem) -> Option<MisfitReason> {
    let here = OperatingSystem::here();
    let processors = code.processors.join(" and ");
    let what = match code.form {
        FileForm::Library => "a library",
        FileForm::Program => "a program",
        FileForm::Object => "an object file",
    };
    if system != here {
        let reason = format!(
            "it is {what} for {} on {processors}, and this program runs on {} on {ARCH}",
            system.name(),
            here.name()
        );
        return Some((
            reason,
            format!("take its build for {} on {ARCH}, or build it on this machine", here.name()),
        ));
    }
    if !code.processors.iter().any(|p| p == ARCH) {
        let reason = format!("it is {what} for {processors}, and this program runs on {ARCH}");
        return Some((reason, format!("take its build for {ARCH}, or build it on this machine")));
    }
    match code.form {
        FileForm::Library => None,
        FileForm::Program => Some(("it is a program, not a library".into(), as_library())),
        FileForm::Object => Some(("it is an object file, which is not linked yet".into(), as_library())),
    }
}

/// How a library is built.
fn as_library() -> String {
    format!(
        "build it as a library and name that, {DLL_PREFIX}NAME{DLL_SUFFIX}: `crate-type = [\"cdylib\"]` in Cargo.toml, `cc -shared` in C"
    )
}

/// A number of `N` bytes, the lowest first.
fn number<const N: usize>(bytes: &[u8], at: usize) -> Option<u64> {
    let slice = bytes.get(at..at.checked_add(N)?)?;
    Some(slice.iter().rev().fold(0, |n, b| n << 8 | u64::from(*b)))
}

fn elf(bytes: &[u8]) -> Option<Code> {
    let (wide, big) = (*bytes.get(4)? == 2, *bytes.get(5)? == 2);
    let half =
        |at: usize| number::<2>(bytes, at).map(|n| if big { u64::from((n as u16).swap_bytes()) } else { n });
    let form = match half(16)? {
        1 => FileForm::Object,
        2 => FileForm::Program,
        3 => FileForm::Library,
        _ => return None,
    };
    let processor = match (half(18)?, wide, big) {
        (3, ..) => "x86",
        (8, _, false) => "mipsel",
        (8, ..) => "mips",
        (20, ..) => "powerpc",
        (21, ..) => "powerpc64",
        (22, true, _) => "s390x",
        (40, ..) => "arm",
        (62, ..) => "x86_64",
        (183, ..) => "aarch64",
        (243, true, _) => "riscv64",
        (243, false, _) => "riscv32",
        (258, ..) => "loongarch64",
        (n, ..) => return Some(Code { form, processors: vec![format!("processor {n}")] }),
    };
    Some(Code { form, processors: vec![processor.into()] })
}

fn pe(bytes: &[u8]) -> Option<Code> {
    const LIBRARY: u64 = 0x2000;
    let at = usize::try_from(number::<4>(bytes, 0x3C)?).ok()?;
    let head = bytes.get(at..)?;
    if !head.starts_with(b"PE\0\0") {
        return None;
    }
    let processor = match number::<2>(head, 4)? {
        0x014C => "x86".into(),
        0x01C0 | 0x01C4 => "arm".into(),
        0x8664 => "x86_64".into(),
        0xAA64 => "aarch64".into(),
        n => format!("processor {n}"),
    };
    let form = if number::<2>(head, 22)? & LIBRARY != 0 { FileForm::Library } else { FileForm::Program };
    Some(Code { form, processors: vec![processor] })
}

fn mach(bytes: &[u8]) -> Option<Code> {
    let form = match number::<4>(bytes, 12)? {
        1 => FileForm::Object,
        2 => FileForm::Program,
        _ => FileForm::Library,
    };
    Some(Code { form, processors: vec![apple(number::<4>(bytes, 4)?)] })
}

/// The processors of a file that holds code for several.
fn fat(bytes: &[u8]) -> Vec<String> {
    let big = |at: usize| number::<4>(bytes, at).map(|n| u64::from((n as u32).swap_bytes()));
    let size = if bytes.get(3) == Some(&0xBF) { 32 } else { 20 };
    let count = big(4).unwrap_or(0) as usize;
    (0..count).filter_map(|i| big(8 + size * i).map(apple)).collect()
}

fn apple(processor: u64) -> String {
    match processor {
        7 => "x86".into(),
        12 => "arm".into(),
        0x0100_0007 => "x86_64".into(),
        0x0100_000C => "aarch64".into(),
        n => format!("processor {n}"),
    }
}

/// A file that is no code of any system.
fn other(bytes: &[u8]) -> MisfitReason {
    let archive = |form: &str| {
        (format!("it is an archive ({form})"), "unpack it, and name the library in it".to_owned())
    };
    match bytes {
        [b'!', b'<', b'a', b'r', b'c', b'h', b'>', ..] | [b'!', b'<', b't', b'h', b'i', b'n', b'>', ..] => {
            ("it is a static library, which can be linked and not loaded".into(), as_library())
        }
        [b'P', b'K', 3, 4, ..] => archive("zip"),
        [0x1F, 0x8B, ..] => archive("gzip"),
        [0xFD, b'7', b'z', b'X', b'Z', ..] => archive("xz"),
        [b'B', b'Z', b'h', ..] => archive("bzip2"),
        [0x28, 0xB5, 0x2F, 0xFD, ..] => archive("zstd"),
        [b'7', b'z', 0xBC, 0xAF, ..] => archive("7z"),
        [0, b'a', b's', b'm', ..] => {
            ("it is WebAssembly, which this program does not run".into(), as_library())
        }
        [b'B', b'C', 0xC0, 0xDE, ..] => ("it is code of LLVM before linking".into(), as_library()),
        _ if bytes.get(257..262) == Some(b"ustar") => archive("tar"),
        _ => text(bytes).unwrap_or_else(|| {
            let first: Vec<String> = bytes.iter().take(4).map(|b| format!("{b:02x}")).collect();
            (format!("it is no library: it begins with the bytes {}", first.join(" ")), built())
        }),
    }
}

/// A text in place of a library.
fn text(bytes: &[u8]) -> Option<MisfitReason> {
    let text = std::str::from_utf8(bytes).ok()?;
    if text.contains(|c: char| c.is_control() && !c.is_whitespace()) {
        return None;
    }
    if text.starts_with("version https://git-lfs.") {
        let reason = "it is a pointer of Git LFS, which stands in place of the library";
        return Some((reason.into(), "`git lfs pull` fetches the library".into()));
    }
    let first = text.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or("");
    let lower = first.to_ascii_lowercase();
    if lower.starts_with("<!doctype html") || lower.starts_with("<html") {
        let hint = "the download gave a page in place of the file: fetch the file itself";
        return Some(("it is a web page, not a library".into(), hint.into()));
    }
    let mut shown: String = first.chars().take(MOST_SHOWN).collect();
    if first.chars().count() > MOST_SHOWN {
        shown.push_str("...");
    }
    Some((format!("it is a text, not a library: it begins with `{shown}`"), built()))
}

/// Which file to name.
fn built() -> String {
    format!("name the library that the build makes, like target/release/{DLL_PREFIX}toile_sdf{DLL_SUFFIX}")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// The head of a Linux file of that kind, for that processor.
    fn linux(kind: u8, machine: u8) -> Vec<u8> {
        let mut b = vec![0; 64];
        b[..6].copy_from_slice(&[0x7F, b'E', b'L', b'F', 2, 1]);
        (b[16], b[18]) = (kind, machine);
        b
    }

    fn windows(machine: [u8; 2], is_library: bool) -> Vec<u8> {
        let mut b = vec![0; 0x80];
        b[..2].copy_from_slice(b"MZ");
        b[0x3C] = 0x40;
        b[0x40..0x44].copy_from_slice(b"PE\0\0");
        b[0x44..0x46].copy_from_slice(&machine);
        b[0x40 + 23] = if is_library { 0x20 } else { 0 };
        b
    }

    fn reason(bytes: &[u8]) -> String {
        foreign(bytes).unwrap().0
    }

    #[test]
    #[cfg(all(target_os = "linux", target_arch = "x86_64"))]
    fn libraries_of_other_systems_and_processors_are_named() {
        assert_eq!(foreign(&linux(3, 62)), None);
        assert_eq!(reason(&linux(3, 183)), "it is a library for aarch64, and this program runs on x86_64");
        assert_eq!(
            reason(&linux(3, 77)),
            "it is a library for processor 77, and this program runs on x86_64"
        );
        let on = "and this program runs on Linux on x86_64";
        let (reason_of, hint) = foreign(&windows([0x64, 0x86], true)).unwrap();
        assert_eq!(reason_of, format!("it is a library for Windows on x86_64, {on}"));
        assert_eq!(hint, "take its build for Linux on x86_64, or build it on this machine");
        assert_eq!(
            reason(&windows([0x64, 0xAA], false)),
            format!("it is a program for Windows on aarch64, {on}")
        );
        let mut mac = vec![0; 32];
        mac[..4].copy_from_slice(&[0xCF, 0xFA, 0xED, 0xFE]);
        (mac[4], mac[7], mac[12]) = (12, 1, 6);
        assert_eq!(reason(&mac), format!("it is a library for macOS on aarch64, {on}"));
        let mut both = vec![0; 48];
        both[..8].copy_from_slice(&[0xCA, 0xFE, 0xBA, 0xBE, 0, 0, 0, 2]);
        (both[8], both[11], both[28], both[31]) = (1, 7, 1, 12);
        assert_eq!(reason(&both), format!("it is a library for macOS on x86_64 and aarch64, {on}"));
    }

    #[test]
    #[cfg(all(target_os = "linux", target_arch = "x86_64"))]
    fn programs_and_objects_of_this_machine_are_no_libraries() {
        assert_eq!(reason(&linux(2, 62)), "it is a program, not a library");
        let (object, hint) = foreign(&linux(1, 62)).unwrap();
        assert_eq!(object, "it is an object file, which is not linked yet");
        assert_eq!(
            hint,
            "build it as a library and name that, libNAME.so: `crate-type = [\"cdylib\"]` in Cargo.toml, `cc -shared` in C"
        );
    }

    #[test]
    fn what_is_no_code_is_called_what_it_is() {
        let named = "name the library that the build makes, like target/release/";
        assert_eq!(reason(b""), "it is empty");
        let (words, hint) = foreign(b"\n#!/bin/sh\ncargo build\n").unwrap();
        assert_eq!(words, "it is a text, not a library: it begins with `#!/bin/sh`");
        assert!(hint.starts_with(named), "{hint}");
        let long = format!("{} end", "word ".repeat(20));
        let shown = "word word word word word word word word ...";
        assert_eq!(reason(long.as_bytes()), format!("it is a text, not a library: it begins with `{shown}`"));
        assert_eq!(reason(b"<!DOCTYPE html><html>"), "it is a web page, not a library");
        let pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:00\n";
        assert_eq!(
            foreign(pointer),
            Some((
                "it is a pointer of Git LFS, which stands in place of the library".into(),
                "`git lfs pull` fetches the library".into()
            ))
        );
        assert_eq!(reason(b"!<arch>\nlib.o/"), "it is a static library, which can be linked and not loaded");
        assert_eq!(reason(b"PK\x03\x04\x14\0"), "it is an archive (zip)");
        assert_eq!(reason(b"\0asm\x01\0\0\0"), "it is WebAssembly, which this program does not run");
        assert_eq!(reason(b"\x89PNG\r\n\x1a\n\0"), "it is no library: it begins with the bytes 89 50 4e 47");
    }

    #[test]
    fn no_bytes_panic() {
        for head in
            [linux(3, 62), windows([0x64, 0x86], true), vec![0xCF, 0xFA, 0xED, 0xFE], b"!<arch>\n".to_vec()]
        {
            for length in 0..head.len() {
                let _ = foreign(&head[..length]);
            }
            for at in 0..head.len() {
                for value in [0, 1, 0x7F, 0xFF] {
                    let mut head = head.clone();
                    head[at] = value;
                    let _ = foreign(&head);
                }
            }
        }
    }
}

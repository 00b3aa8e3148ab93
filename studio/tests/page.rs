//! The page's files.

use crate::kit::{MASKS, Served, folder};
use std::path::{Path, PathBuf};

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("page")
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()) {
        if entry.is_dir() { files(&entry, found) } else { found.push(entry) }
    }
}

#[test]
fn every_file_of_the_page_is_served_as_it_is() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let mut all = Vec::new();
    files(&page(), &mut all);
    for file in all {
        let path = file.strip_prefix(page()).unwrap().to_str().unwrap().replace('\\', "/");
        let reply = served.client.get(&format!("/{path}"));
        assert_eq!((reply.status, reply.body == std::fs::read(&file).unwrap()), (200, true), "{path}");
    }
    assert_eq!(served.client.get("/").body, std::fs::read(page().join("index.html")).unwrap());
    assert_eq!(served.client.request("POST", "/index.html", "", b"").status, 405);
}

/// Files of others are those that their authors gave: each is in a list of digests beside them, in
/// the form of `sha256sum`.
#[test]
fn the_bundled_libraries_have_their_digests() {
    let vendor = page().join("vendor");
    if !vendor.is_dir() {
        return;
    }
    let list = std::fs::read_to_string(vendor.join("SHA256")).unwrap();
    let mut listed = 0;
    for line in list.lines().filter(|l| !l.trim().is_empty()) {
        let (digest, name) = line.split_once(' ').unwrap();
        let bytes = std::fs::read(vendor.join(name.trim().trim_start_matches('*'))).unwrap();
        assert_eq!(sha256(&bytes), digest, "{name}");
        listed += 1;
    }
    let mut all = Vec::new();
    files(&vendor, &mut all);
    let code = all.iter().filter(|f| f.extension().is_some_and(|e| e == "js")).count();
    assert!(listed >= code, "{listed} digests of {code} files of code");
}

/// FIPS 180-4.
fn sha256(bytes: &[u8]) -> String {
    let primes = (2u64..).filter(|n| (2..*n).take_while(|d| d * d <= *n).all(|d| n % d != 0)).take(64);
    let part = |root: f64| ((root.fract()) * 4_294_967_296.0) as u32;
    let primes: Vec<u64> = primes.collect();
    let k: Vec<u32> = primes.iter().map(|p| part((*p as f64).cbrt())).collect();
    let mut h: Vec<u32> = primes.iter().take(8).map(|p| part((*p as f64).sqrt())).collect();
    let mut message = bytes.to_vec();
    message.push(0x80);
    message.resize((message.len() + 8).next_multiple_of(64) - 8, 0);
    message.extend((8 * bytes.len() as u64).to_be_bytes());
    for block in message.chunks(64) {
        let mut w: Vec<u32> = block.chunks(4).map(|c| u32::from_be_bytes(c.try_into().unwrap())).collect();
        for t in 16..64 {
            let (a, b) = (w[t - 15], w[t - 2]);
            let one = a.rotate_right(7) ^ a.rotate_right(18) ^ (a >> 3);
            let other = b.rotate_right(17) ^ b.rotate_right(19) ^ (b >> 10);
            w.push(w[t - 16].wrapping_add(one).wrapping_add(w[t - 7]).wrapping_add(other));
        }
        let mut v = h.clone();
        for t in 0..64 {
            let s1 = v[4].rotate_right(6) ^ v[4].rotate_right(11) ^ v[4].rotate_right(25);
            let choice = (v[4] & v[5]) ^ (!v[4] & v[6]);
            let one = v[7].wrapping_add(s1).wrapping_add(choice).wrapping_add(k[t]).wrapping_add(w[t]);
            let s0 = v[0].rotate_right(2) ^ v[0].rotate_right(13) ^ v[0].rotate_right(22);
            let majority = (v[0] & v[1]) ^ (v[0] & v[2]) ^ (v[1] & v[2]);
            v.rotate_right(1);
            v[4] = v[4].wrapping_add(one);
            v[0] = one.wrapping_add(s0).wrapping_add(majority);
        }
        h.iter_mut().zip(v).for_each(|(h, v)| *h = h.wrapping_add(v));
    }
    h.iter().map(|h| format!("{h:08x}")).collect()
}

#[test]
fn the_digest_is_that_of_the_standard() {
    assert_eq!(sha256(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    assert_eq!(sha256(b""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

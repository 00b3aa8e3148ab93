//! The page's files, which are part of the program.

include!(concat!(env!("OUT_DIR"), "/page_files.rs"));

/// What a browser is told of a file, by its ending.
pub(crate) fn media_type(path: &str) -> &'static str {
    match path.rsplit('.').next().unwrap_or("").to_ascii_lowercase().as_str() {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "json" => "application/json",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "webp" => "image/webp",
        "pdf" => "application/pdf",
        "glb" => "model/gltf-binary",
        "woff2" => "font/woff2",
        "txt" | "md" | "obj" | "mtl" | "ron" | "dxf" | "plt" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

/// The file of a path: `index.html` for the root.
pub(crate) fn file(path: &str) -> Option<(&'static str, &'static [u8])> {
    let path = path.trim_start_matches('/');
    let path = if path.is_empty() { "index.html" } else { path };
    FILES.iter().find(|(name, _)| *name == path).map(|(name, bytes)| (media_type(name), *bytes))
}

//! The header for C says what the library does. To write it anew: `FLOE_WRITE_HEADER=1 cargo test --test capi_header`.
#![allow(clippy::unwrap_used)]

use std::path::Path;

const HEADER: &str = "include/floe.h";

#[test]
fn the_header_is_that_of_the_sources() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).unwrap();
    let builder = cbindgen::Builder::new().with_config(config);
    let sources = ["status", "scene", "functions"];
    let builder =
        sources.iter().fold(builder, |b, name| b.with_src(root.join(format!("src/capi/{name}.rs"))));
    let mut bytes = Vec::new();
    builder.generate().unwrap().write(&mut bytes);
    let text = String::from_utf8(bytes).unwrap();
    for name in ["floe_scene_open", "floe_free", "FLOE_STATUS_BAD_SCENE = 78"] {
        assert!(text.contains(name), "{name} is not in\n{text}");
    }
    if std::env::var_os("FLOE_WRITE_HEADER").is_some() {
        std::fs::write(root.join(HEADER), &text).unwrap();
    }
    let there = std::fs::read_to_string(root.join(HEADER)).unwrap();
    assert!(text == there, "{HEADER} is not what the sources say; write it anew with FLOE_WRITE_HEADER=1");
}

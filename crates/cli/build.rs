//! Looks for the engine of pages: without it the program builds, and `live` says what it needs.

fn main() {
    const ENGINE: &str = "../../assets/web/engine.wasm.gz";
    println!("cargo::rerun-if-changed={ENGINE}");
    println!("cargo::rustc-check-cfg=cfg(page_engine)");
    if std::path::Path::new(ENGINE).exists() {
        println!("cargo::rustc-cfg=page_engine");
    }
}

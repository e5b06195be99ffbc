//! Makes Rust of `proto/*.proto`. protox reads them in place of `protoc`, which nobody has to install for this.

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=proto");
    let files = protox::compile(["service.proto"], ["proto"])?;
    tonic_prost_build::configure()
        // In order of their keys, so that the same values are the same bytes.
        .btree_map(".")
        .compile_fds(files)?;
    Ok(())
}

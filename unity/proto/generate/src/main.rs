//! Writes Rust of the `.proto` files in a folder: `driftworld-unity-protocol PROTO_FOLDER OUTPUT_FOLDER`. The file is named after the
//! protocol's package, `communicator_objects.rs`.

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folders: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [proto, output] = folders.as_slice() else {
        return Err("expected two folders: that of the .proto files, and one for the Rust file".into());
    };
    let files = protox::compile(["service.proto"], [proto])?;
    tonic_prost_build::configure()
        // In order of their keys, so that the same values are the same bytes.
        .btree_map(".")
        .emit_rerun_if_changed(false)
        .out_dir(output)
        .compile_fds(files)?;
    Ok(())
}

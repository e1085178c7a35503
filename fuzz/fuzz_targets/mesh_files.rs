//! OBJ and PLY, into cages and fixed meshes.
#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| acceptance::files::mesh_files(bytes));

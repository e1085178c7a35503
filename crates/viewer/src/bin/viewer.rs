//! The program of the page. Elsewhere there is nothing for it to do.

fn main() {
    ductile_viewer::web::start();
}

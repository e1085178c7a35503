//! The words that cross a boundary: document, edit, request, reply, frame layout, share link.

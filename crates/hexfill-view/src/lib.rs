//! One self-contained HTML file that shows a hex mesh

//! Units at the edges.

//! What the published percentages could mean: our shares under every reading, and how far each is from the printed ones.

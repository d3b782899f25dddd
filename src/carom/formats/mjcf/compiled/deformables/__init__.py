"""`<deformable>`: flexes on bodies that are listed, and skins."""

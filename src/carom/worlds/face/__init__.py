"""What many worlds offer beside their bodies: questions, logs and files."""

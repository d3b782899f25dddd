"""What readers of robot files take from them, and the report of what they leave out."""

"""Parts of DeepMimic that work without recorded motions of people, which Carom may not distribute."""

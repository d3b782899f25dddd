"""What DeepMimic needs besides the recorded motions of people, which are not Carom's to pass on."""

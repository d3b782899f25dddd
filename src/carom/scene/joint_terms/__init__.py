"""What joints do by themselves: armature, damping, springs and friction."""

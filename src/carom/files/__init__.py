"""What all readers of files share: the budget of a reading, regular files, packed files, XML, and errors."""

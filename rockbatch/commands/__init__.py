"""What the terminal takes and prints: a module for each command, loaded when it is called."""

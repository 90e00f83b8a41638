"""Forces and motions that a designer sizes."""

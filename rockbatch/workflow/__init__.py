"""From a study to its results in a folder, judged and reported; and analyses, likewise."""

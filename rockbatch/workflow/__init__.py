"""Run studies and analyses: results in a folder, checked and reported."""

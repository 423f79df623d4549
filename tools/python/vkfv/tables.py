"""Tables of numbers in CSV files."""

import csv
import os


def read_records(path: str | os.PathLike) -> list[dict]:
    """The lines of a CSV file as dictionaries by the names in its head; numbers as numbers, empty cells as None."""

    def value(text: str):
        if text == "":
            return None
        for kind in (int, float):
            try:
                return kind(text)
            except ValueError:
                pass
        return text

    with open(path, newline="", encoding="utf-8") as file:
        return [{key: value(text) for key, text in row.items()} for row in csv.DictReader(file)]

"""Tables between markers of a page of docs/."""

import sys


def replaced(page, marker, lines):
    """The text `page` with `lines` between <!-- marker begin --> and <!-- marker end -->; ends the program without."""
    begin, end = f"<!-- {marker} begin -->", f"<!-- {marker} end -->"
    before, found_begin, rest = page.partition(begin)
    _, found_end, after = rest.partition(end)
    if not (found_begin and found_end):
        sys.exit(f"{sys.argv[0]}: error: the page has no markers {begin} and {end}")
    return "\n".join([before + begin, *lines, end + after])

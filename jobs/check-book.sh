#!/bin/bash
# check-book.sh FOLDER: whether a built book stands by itself. Its pages may link to other places, but load nothing from
# there, and no equation may have been left as it was written.
set -euo pipefail

book=$1
wrong=0
complain() {
    echo "error: $1:" >&2
    sed 's/^/  /' >&2
    wrong=1
}

# Whatever a browser loads by itself: not the `href` of a link in the text (`<a>`).
loads='<(script|img|iframe|source|link|video|audio|object|embed)[^>]*(src|href|data)="(https?:)?//[^"]*"'
if found=$(grep -rEo --include='*.html' "$loads" "$book"); then
    complain "the book loads from the network" <<<"$found"
fi
styles='url\(["'\'']?(https?:)?//[^)]*\)|@import[^;]*https?://[^;]*'
if found=$(grep -rEo --include='*.css' "$styles" "$book"); then
    complain "a style sheet loads from the network" <<<"$found"
fi
# KaTeX leaves what it cannot read between its signs.
if found=$(grep -rEno --include='*.html' '\$\$.{0,60}' "$book"); then
    complain "an equation is not typeset" <<<"$found"
fi
exit "$wrong"

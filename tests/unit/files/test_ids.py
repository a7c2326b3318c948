"""Ids from names that people write."""

import pytest

from calm.files.catalogue import tidy_id


@pytest.mark.parametrize(
    ("name", "id"),
    [
        ("Bøye", "boye"),
        ("Utløser", "utloser"),
        ("Stålvaier", "stalvaier"),
        ("Æsj", "aesj"),
        ("Bouée à 40 m", "bouee-a-40-m"),
        ("Große Kugel", "grosse-kugel"),
        ("shackle 1½", "shackle-1-1-2"),
        ("chain — long", "chain-long"),
        ("浮", ""),
    ],
)
def test_letters_lose_their_accents_and_none_is_dropped(name, id):
    assert tidy_id(name) == id

"""All pages of the gallery, in their order."""

from scenes.lab.gallery import contacts, extremes, masks, motions, piles, sweeps

PAGES = (*sweeps.PAGES, *piles.PAGES, *contacts.PAGES, *motions.PAGES, *masks.PAGES, *extremes.PAGES)

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqVoxplexLabelTableWidget.h"

#include "pqVoxplexLabelModel.h"

#include "vtkSMLabelColorsProxy.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqTreeView.h"

#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkSMProperty.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMUncheckedPropertyHelper.h"

#include <QHeaderView>
#include <QItemSelectionModel>
#include <QLabel>
#include <QLineEdit>
#include <QSortFilterProxyModel>
#include <QVBoxLayout>

#include <algorithm>

namespace
{

/** A narrow panel shows this much of a name. */
constexpr int LettersOfNames = 18;

/** Labels that are searched for, in the order of a column. What is changed in one selected row is changed in all. */
class ShownLabels : public QSortFilterProxyModel
{
public:
  explicit ShownLabels(pqVoxplexLabelModel* labels, QObject* parent)
    : QSortFilterProxyModel(parent)
    , Labels(labels)
  {
    this->setSourceModel(labels);
    this->setFilterRole(pqVoxplexLabelModel::SearchRole);
    this->setFilterCaseSensitivity(Qt::CaseInsensitive);
    this->setSortRole(pqVoxplexLabelModel::SortRole);
    this->setSortCaseSensitivity(Qt::CaseInsensitive);
    this->setDynamicSortFilter(false); // a row stays under the mouse
  }

  bool setData(const QModelIndex& index, const QVariant& value, int) override
  {
    const QItemSelectionModel& selection = *this->View->selectionModel();
    QModelIndexList changed = { index };
    if (selection.isRowSelected(index.row(), QModelIndex()))
    {
      changed = selection.selectedRows();
    }
    QList<int> rows;
    for (const QModelIndex& one : changed)
    {
      rows << this->mapToSource(one).row();
    }
    return this->Labels->setRows(rows, index.column(), value);
  }

  QAbstractItemView* View = nullptr;

private:
  pqVoxplexLabelModel* Labels;
};

} // namespace

pqVoxplexLabelTableWidget::pqVoxplexLabelTableWidget(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : Superclass(proxy, parent)
  , Model(new pqVoxplexLabelModel(this))
  , View(new pqTreeView(this, true))
  , Summary(new QLabel(this))
{
  auto* const shown = new ShownLabels(this->Model, this);
  shown->View = this->View;

  auto* const search = new QLineEdit(this);
  search->setObjectName("SearchLabels");
  search->setPlaceholderText(tr("Search labels by name or number"));
  search->setClearButtonEnabled(true);
  this->connect(
    search, &QLineEdit::textChanged, shown, &QSortFilterProxyModel::setFilterFixedString);

  this->View->setObjectName("Labels");
  this->View->setRootIsDecorated(false);
  this->View->setUniformRowHeights(true);
  this->View->setAllColumnsShowFocus(true);
  this->View->setSelectionMode(QAbstractItemView::ExtendedSelection);
  this->View->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed |
    QAbstractItemView::AnyKeyPressed);
  this->View->setModel(shown);
  this->View->header()->setSectionsClickable(true);
  this->View->header()->setStretchLastSection(false);
  this->View->header()->setMinimumSectionSize(20);
  this->View->header()->setSortIndicator(-1, Qt::AscendingOrder); // by label
  this->View->setSortingEnabled(true);
  this->View->setMaximumRowCountBeforeScrolling(8);

  this->connect(this->View->header(), &QHeaderView::sortIndicatorChanged, this,
    &pqVoxplexLabelTableWidget::fitColumns);

  this->Summary->setObjectName("Summary");
  this->Summary->setWordWrap(true);

  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(search);
  layout->addWidget(this->View);
  layout->addWidget(this->Summary);
  this->setShowLabel(false);

  this->connect(this->Model, &pqVoxplexLabelModel::settingsChanged, this,
    &pqVoxplexLabelTableWidget::settingsChanged);
  this->connect(
    this->Model, &QAbstractItemModel::modelReset, this, &pqVoxplexLabelTableWidget::showSummary);
  this->connect(
    this->Model, &QAbstractItemModel::dataChanged, this, &pqVoxplexLabelTableWidget::showSummary);
  this->addPropertyLink(this, "settings", SIGNAL(settingsChanged()), property);

  this->connect(pqApplicationCore::instance()->getServerManagerModel(),
    &pqServerManagerModel::dataUpdated, this, &pqVoxplexLabelTableWidget::onDataUpdated);
  for (const char* name : { "Input", "LabelArray", "InputMode" })
  {
    pqCoreUtilities::connect(
      proxy->GetProperty(name), vtkCommand::UncheckedPropertyModifiedEvent, this, SLOT(gather()));
  }
}

QList<QVariant> pqVoxplexLabelTableWidget::settings() const
{
  return this->Model->settings();
}

void pqVoxplexLabelTableWidget::setSettings(const QList<QVariant>& values)
{
  this->Model->setSettings(values);
}

//----------------------------------------------------------------------------------------------------
void pqVoxplexLabelTableWidget::showEvent(QShowEvent* event)
{
  this->Superclass::showEvent(event);
  if (this->IsStale)
  {
    this->gather();
  }
}

void pqVoxplexLabelTableWidget::onDataUpdated(pqPipelineSource* source)
{
  if (source->getProxy() == vtkSMUncheckedPropertyHelper(this->proxy(), "Input").GetAsProxy())
  {
    this->gather();
  }
}

void pqVoxplexLabelTableWidget::gather()
{
  this->IsStale = !this->isVisible();
  vtkSMUncheckedPropertyHelper input(this->proxy(), "Input");
  auto* const source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  if (this->IsStale || source == nullptr)
  {
    return;
  }
  vtkNew<vtkPVLabelInformation> labels;
  this->Problem = tr("No labels: the Input Mode is Isosurface.");
  if (vtkSMUncheckedPropertyHelper(this->proxy(), "InputMode").GetAsInt() == 0)
  {
    vtkSMUncheckedPropertyHelper array(this->proxy(), "LabelArray");
    labels->SetArray(QString(array.GetAsString(3)).toInt(), array.GetAsString(4));
    vtkSMLabelColorsProxy::Gather(source, input.GetOutputPort(), labels);
    this->Problem = QString::fromStdString(labels->GetErrorMessage());
  }
  this->Model->setLabels(labels->GetLabels());
  if (labels->GetLabels().empty() && this->Problem.isEmpty())
  {
    this->Problem = tr("No labels yet: the input has no data. Press Apply there.");
  }
  this->showSummary();
  this->fitColumns();
}

void pqVoxplexLabelTableWidget::resizeEvent(QResizeEvent* event)
{
  this->Superclass::resizeEvent(event);
  this->fitColumns();
}

/** Names get what is left, and at least LettersOfNames. Only the sorted column has room for its arrow. */
void pqVoxplexLabelTableWidget::fitColumns()
{
  QHeaderView* const header = this->View->header();
  const QAbstractItemView* const view = this->View;
  for (int column = 0; column < pqVoxplexLabelModel::NumberOfColumns; ++column)
  {
    const QString text = column == pqVoxplexLabelModel::Size
      ? QString("00.000")
      : this->Model->headerData(column, Qt::Horizontal, Qt::DisplayRole).toString();
    header->resizeSection(column,
      std::max(
        view->sizeHintForColumn(column), header->fontMetrics().horizontalAdvance(text) + 12));
  }
  if (header->sortIndicatorSection() >= 0)
  {
    this->View->resizeColumnToContents(header->sortIndicatorSection());
  }
  const int least = std::min(view->sizeHintForColumn(pqVoxplexLabelModel::Name),
    LettersOfNames * header->fontMetrics().averageCharWidth());
  const int left =
    view->viewport()->width() - header->length() + header->sectionSize(pqVoxplexLabelModel::Name);
  header->resizeSection(pqVoxplexLabelModel::Name, std::max(left, least));
}

void pqVoxplexLabelTableWidget::showSummary()
{
  this->Summary->setText(this->Problem.isEmpty() ? tr("%1 of %2 labels are meshed")
                                                     .arg(this->Model->numberMeshed())
                                                     .arg(this->Model->numberOfLabels())
                                                 : this->Problem);
}
